/** The materials that draw a paint on a mesh, as the worker prints it. */
import {
  Color,
  DoubleSide,
  MeshBasicMaterial,
  MeshStandardMaterial,
  Vector3,
  type IUniform,
  type Material,
  type Texture,
  type WebGLRenderer,
} from 'three';
import type { Look } from '../model/mesh';
import { type Quaternion, type Vec3 } from '../model/pose';
import { attempt } from '../model/result';
import type { BoxLayer } from './axis_distance';
import type { Paint, PaintedLayer } from './paint';
import { PictureTextures } from './picture_texture';
import { place, type Placement, type Solid } from './placement';
import { fragmentHead, vertexBody, vertexHead, type LayerKind } from './shader';

/** The mesh that a paint is on. */
export interface PaintedMesh extends Solid {
  uvs?: Float32Array | undefined;
  colours?: Uint16Array | undefined;
  /** A point near it, in units of the file. */
  middle: Vec3;
}

type Uniforms = Record<string, IUniform>;

/** A layer that can be shown. */
interface Shown {
  layer: PaintedLayer;
  kind: LayerKind;
  placement?: Placement | undefined;
}

/** Without a paint, the model has its own look. */
const kOwn: Paint = { layers: [{ layer: { projection: 'uv' } }] };

function kindOf({ layer, picture, colour }: PaintedLayer): LayerKind {
  const { projection } = layer;
  if (picture) return { projection, shows: 'picture' };
  return { projection, shows: projection === 'uv' && colour === undefined ? 'own' : 'colour' };
}

/** Finds the place of a layer; undefined for layers that the worker refuses. */
function show(layer: PaintedLayer, mesh: PaintedMesh, rotation: Quaternion): Shown | undefined {
  const kind = kindOf(layer);
  if (kind.projection === 'vertex_colors') return mesh.colours && { layer, kind };
  if (kind.projection === 'uv')
    return kind.shows === 'picture' && !mesh.uvs ? undefined : { layer, kind };
  const aspect = layer.picture ? layer.picture.width / layer.picture.height : 1;
  const placed = attempt(() => place(layer.layer, mesh, rotation, aspect));
  return placed.ok ? { layer, kind, placement: placed.value } : undefined;
}

const vector = (v: Vec3): Vector3 => new Vector3(v[0], v[1], v[2]);
const linear = (colour: string | undefined): Color => new Color(colour ?? '#ffffff');

/** `struct Place` of the shader. `middle_mm` is the origin of its points: small numbers keep their digits. */
const placeUniform = (at: Placement, middle_mm: Vec3) => ({
  position: vector(at.position_mm).sub(vector(middle_mm)),
  right: vector(at.right),
  up: vector(at.up),
  ahead: vector(at.direction),
  width: at.width_mm,
  height: at.height_mm,
  radius: at.radius_mm,
  depth: at.depth_mm,
  blend: at.blend_mm,
  turn: at.turn_rad,
  mirror: at.mirror ? -1 : 1,
});

/** A paint on a mesh: computes the places of the layers, and creates the materials. */
export class PaintLook {
  private readonly textures: PictureTextures;
  /** Shared by all materials. Their values change with the paint. */
  private readonly uniforms: Uniforms = { hasDistances: { value: false } };
  private looks: readonly Look[] = [];
  private shown: Shown[] = [];
  private key = '';

  constructor(renderer: WebGLRenderer) {
    this.textures = new PictureTextures(renderer);
  }

  /**
   * Changes what the materials show.
   * @param rotation  from frame O to frame F at the start of the dip
   * @param looks     the own look of each part of the mesh
   * @return false if the materials have to be created again
   */
  update(
    paint: Paint | undefined,
    mesh: PaintedMesh,
    rotation: Quaternion,
    looks: readonly Look[],
  ): boolean {
    const { base_colour, layers } = paint ?? kOwn;
    this.shown = layers.flatMap((layer) => show(layer, mesh, rotation) ?? []);
    const { middle, scale = 1 } = mesh;
    const middle_mm: Vec3 = [scale * middle[0], scale * middle[1], scale * middle[2]];
    this.set('paintMiddle', vector(middle));
    this.set('paintScale', scale);
    this.set('baseColour', linear(base_colour));
    this.set('hasOwnColours', mesh.colours !== undefined);
    this.shown.forEach((layer, i) => this.setLayer(layer, i, middle_mm));
    this.keepPictures(looks);
    const key = JSON.stringify(this.shown.map(({ kind }) => kind));
    const isSame = key === this.key && looks === this.looks;
    this.key = key;
    this.looks = looks;
    return isSame;
  }

  /** The layers that blend between axes; one entry per layer. */
  boxes(): (BoxLayer | undefined)[] {
    return this.shown.map(({ kind, placement }) => {
      if (kind.projection !== 'box' || kind.shows !== 'picture' || !placement) return undefined;
      const { right, up, direction, blend_mm } = placement;
      return { axes: [right, up, direction], blend_mm };
    });
  }

  /** Says whether the mesh has the distances to the axes of boxes(). */
  setHasDistances(hasDistances: boolean): void {
    this.set('hasDistances', hasDistances);
  }

  /** Creates a material per part of the mesh. `isLit`: false for the exact colours. */
  materials(isLit = true): Material[] {
    return this.looks.map((look) => this.materialOf(look, isLit));
  }

  /** Draws the pictures' textures again at the next update(), which then needs new materials. */
  forget(): void {
    this.textures.dispose();
    this.key = '';
  }

  dispose(): void {
    this.textures.dispose();
  }

  private set(name: string, value: unknown): void {
    const uniform = (this.uniforms[name] ??= { value: undefined });
    uniform.value = value;
  }

  private setLayer({ layer, kind, placement }: Shown, i: number, middle_mm: Vec3): void {
    const { repeat, opacity = 1 } = layer.layer;
    this.set(`opacity${i}`, opacity);
    this.set(`colour${i}`, linear(layer.colour));
    if (placement) this.set(`place${i}`, placeUniform(placement, middle_mm));
    if (kind.shows !== 'picture' || !layer.picture) return;
    const repeats = placement ? placement.repeat : (repeat ?? true);
    const wrap = repeats ? 'repeat' : 'clamp';
    this.set(`picture${i}`, this.textures.of(layer.picture, [wrap, wrap]));
  }

  private keepPictures(looks: readonly Look[]): void {
    const used = [...looks, ...this.shown.map(({ layer }) => layer)];
    this.textures.keep(new Set(used.flatMap(({ picture }) => picture ?? [])));
  }

  /** The uniforms of the model's own look. */
  private ownUniforms({ colour, picture, wrap }: Look): Uniforms {
    const texture: Texture | null = picture ? this.textures.of(picture, wrap) : null;
    return {
      ownTint: { value: new Color(...colour) },
      ownPicture: { value: texture },
      hasOwnPicture: { value: texture !== null },
    };
  }

  private materialOf(look: Look, isLit: boolean): Material {
    const material = isLit
      ? new MeshStandardMaterial({ roughness: 0.85, side: DoubleSide })
      : new MeshBasicMaterial({ side: DoubleSide });
    const own = this.ownUniforms(look);
    const kinds = this.shown.map(({ kind }) => kind);
    material.customProgramCacheKey = () => this.key;
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms, own);
      shader.vertexShader = (vertexHead(kinds) + shader.vertexShader).replace(
        '#include <begin_vertex>',
        `#include <begin_vertex>\n${vertexBody(kinds)}`,
      );
      shader.fragmentShader = (fragmentHead(kinds) + shader.fragmentShader).replace(
        '#include <map_fragment>',
        'diffuseColor.rgb *= paintedColour();',
      );
    };
    return material;
  }
}
