/** 3D view of the result of a dip: predicted appearance, stretch of the film, stated error, or contact time. */
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  Mesh as Mesh3,
  MeshBasicMaterial,
  MeshStandardMaterial,
  OrthographicCamera,
  Quaternion as Quaternion3,
  Scene,
  SRGBColorSpace,
  SphereGeometry,
  Texture,
  Vector2,
  Vector3,
} from 'three';
import { colourOf, kNoValue, place, type Rgb, type Scale } from '../model/colour_map';
import type { Film } from '../model/film';
import type { Quaternion, Vec3 } from '../model/pose';
import type { SurfaceMap } from '../model/surface_map';
import { Stage, type Side } from './stage';

export type Mode = 'predicted' | 'stretch' | 'error' | 'contact';

/** Pose of the object at first contact: the API's X_FO, with z such that the object touches the water. */
export interface Start {
  rotation: Quaternion;
  translation_mm: Vec3;
}

export class ResultView {
  private readonly stage: Stage;
  private readonly object = new Group();
  private readonly geometry = new BufferGeometry();
  private readonly painted = new MeshStandardMaterial({ roughness: 0.8, side: DoubleSide });
  private readonly coloured = new MeshStandardMaterial({
    roughness: 0.9,
    side: DoubleSide,
    vertexColors: true,
  });
  private readonly bare = new MeshStandardMaterial({
    color: 0x969696,
    roughness: 0.9,
    side: DoubleSide,
  });
  private readonly mesh: Mesh3;
  private readonly mark = new Mesh3(
    new BufferGeometry(),
    new MeshBasicMaterial({
      color: 0xff2bd6,
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: -2,
    }),
  );
  private readonly pin = new Mesh3(
    new SphereGeometry(2.5, 16, 12),
    new MeshBasicMaterial({ color: 0xff2bd6, depthTest: false }),
  );
  private readonly centre: Vector3;
  private readonly reach_mm: number;

  constructor(
    host: HTMLElement,
    private readonly map: SurfaceMap,
    private readonly start: Start,
    film: Film,
    private readonly speed_mm_per_s: number,
  ) {
    this.stage = new Stage(host);
    this.stage.setFilm(film);
    this.geometry.setAttribute('position', new BufferAttribute(map.positions, 3));
    this.geometry.setAttribute(
      'color',
      new BufferAttribute(new Uint8Array(map.positions.length), 3, true),
    );
    this.geometry.setAttribute('uv', new BufferAttribute(filmUvs(map, film), 2));
    const { wet, bare } = split(map);
    this.geometry.setIndex(new BufferAttribute(Uint32Array.from(wet.concat(bare)), 1));
    this.geometry.addGroup(0, wet.length, 0);
    this.geometry.addGroup(wet.length, bare.length, 1);
    this.geometry.computeVertexNormals();
    this.mesh = new Mesh3(this.geometry, [this.coloured, this.coloured]);
    this.mark.visible = false;
    this.pin.visible = false;
    this.pin.renderOrder = 1;
    const [w, x, y, z] = start.rotation;
    this.object.quaternion.copy(new Quaternion3(x, y, z, w));
    this.object.add(this.mesh, this.mark);
    this.stage.scene.add(this.object, this.pin);
    this.sink(0);
    const { min, max } = map.box;
    const middle = new Vector3(min[0] + max[0], min[1] + max[1], min[2] + max[2]).multiplyScalar(
      0.5,
    );
    this.object.updateMatrixWorld();
    this.centre = middle.applyMatrix4(this.object.matrixWorld);
    this.reach_mm = 0.62 * Math.hypot(max[0] - min[0], max[1] - min[1], max[2] - min[2]);
    this.look('corner');
  }

  /** Sets the film image, which becomes the texture of the object. */
  setPicture(picture: ImageBitmap): void {
    this.painted.map = textureOf(picture);
    this.painted.needsUpdate = true;
    this.stage.draw();
  }

  showPredicted(): void {
    this.mesh.material = [this.painted, this.bare];
    this.sink(0);
  }

  /** Colours each vertex by its value; NaN means no value. */
  showValues(values: Float32Array, scale: Scale): void {
    this.colour((i) => colourOf(scale.map, place(scale, values[i]!)));
    this.sink(0);
  }

  /** Shows the object immersed as at `time_s`, coloured by contact time. */
  showContact(time_s: number, scale: Scale): void {
    const { contact_s } = this.map;
    this.colour((i) =>
      contact_s[i]! <= time_s ? colourOf(scale.map, place(scale, contact_s[i]!)) : kNoValue,
    );
    this.sink(time_s);
  }

  /** Marks triangles, or a point in the film frame at first contact; without either, removes the mark. */
  point(triangles: readonly number[], place_mm?: Vec3): void {
    this.mark.visible = triangles.length > 0;
    if (this.mark.visible) this.mark.geometry = this.partOf(triangles);
    this.pin.visible = place_mm !== undefined;
    if (place_mm) this.pin.position.set(...place_mm);
    const target = place_mm ? new Vector3(...place_mm) : this.middleOf(triangles);
    if (target) this.lookAt(target);
    this.stage.draw();
  }

  look(side: Side): void {
    this.stage.look(side, this.reach_mm, this.centre);
  }

  /**
   * Renders the film image without compensation: the object's colours projected straight down onto the film.
   * `pitch_mm` is the size of a pixel; the picture covers the film.
   */
  async straightDown(film: Film, pitch_mm: number): Promise<ImageBitmap> {
    const renderer = this.stage.renderer;
    const width = Math.round(film.width_mm / pitch_mm);
    const height = Math.round(film.height_mm / pitch_mm);
    const scene = new Scene();
    const material = new MeshBasicMaterial({ map: this.painted.map, side: DoubleSide });
    const white = new MeshBasicMaterial({ side: DoubleSide });
    const copy = new Mesh3(this.geometry, [material, white]);
    copy.applyMatrix4(this.object.matrixWorld);
    scene.add(copy);
    // Seen from below, because the lower side touches the film, but with x to the right as in the view from above.
    const [x, y] = [film.width_mm / 2, film.height_mm / 2];
    const camera = new OrthographicCamera(x, -x, y, -y, 0.1, 4000);
    camera.up.set(0, 1, 0);
    camera.position.set(0, 0, -1000);
    camera.lookAt(0, 0, 0);
    const size = renderer.getSize(new Vector2());
    const ratio = renderer.getPixelRatio();
    renderer.setPixelRatio(1);
    renderer.setSize(width, height, false);
    renderer.setClearColor(0xffffff, 1);
    renderer.render(scene, camera);
    const bitmap = await createImageBitmap(renderer.domElement);
    renderer.setClearColor(0xffffff, 0);
    renderer.setPixelRatio(ratio);
    renderer.setSize(size.x, size.y);
    material.dispose();
    white.dispose();
    this.stage.draw();
    return bitmap;
  }

  dispose(): void {
    this.stage.dispose();
    this.painted.dispose();
    this.coloured.dispose();
    this.bare.dispose();
  }

  private sink(time_s: number): void {
    const [x, y, z] = this.start.translation_mm;
    this.object.position.set(x, y, z - time_s * this.speed_mm_per_s);
    this.object.updateMatrixWorld();
    this.stage.draw();
  }

  private colour(of: (vertex: number) => Rgb): void {
    const attribute = this.geometry.getAttribute('color') as BufferAttribute;
    const colours = attribute.array as Uint8Array;
    for (let i = 0; i < colours.length / 3; i += 1) {
      const [r, g, b] = of(i);
      colours[3 * i] = r;
      colours[3 * i + 1] = g;
      colours[3 * i + 2] = b;
    }
    attribute.needsUpdate = true;
    this.mesh.material = [this.coloured, this.coloured];
  }

  private partOf(triangles: readonly number[]): BufferGeometry {
    this.mark.geometry.dispose();
    const index = new Uint32Array(3 * triangles.length);
    triangles.forEach((face, i) => {
      for (let k = 0; k < 3; k += 1) index[3 * i + k] = this.map.indices[3 * face + k]!;
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.geometry.getAttribute('position'));
    geometry.setIndex(new BufferAttribute(index, 1));
    return geometry;
  }

  private middleOf(triangles: readonly number[]): Vector3 | undefined {
    if (triangles.length === 0) return undefined;
    const middle = new Vector3();
    for (const face of triangles) {
      const vertex = 3 * this.map.indices[3 * face]!;
      const at = this.map.positions;
      middle.add(new Vector3(at[vertex], at[vertex + 1], at[vertex + 2]));
    }
    middle.divideScalar(triangles.length);
    return middle.applyMatrix4(this.object.matrixWorld);
  }

  /** Moves the camera to a position with a good view of `target`, also if `target` is on the far side. */
  private lookAt(target: Vector3): void {
    const from = target.clone().sub(this.centre);
    if (from.length() < 0.02 * this.reach_mm) return;
    const distance = this.stage.camera.position.distanceTo(this.centre);
    from.z = Math.max(-0.9 * from.length(), from.z);
    this.stage.camera.position.copy(this.centre).addScaledVector(from.normalize(), distance);
    if (Math.hypot(from.x, from.y) < 0.05) this.stage.camera.position.y -= 0.05 * distance;
    this.stage.controls.target.copy(this.centre);
    this.stage.controls.update();
  }
}

/** Texture coordinates of each vertex in the film image, from its lower left corner. */
function filmUvs(map: SurfaceMap, film: Film): Float32Array {
  const uvs = new Float32Array(map.film_mm.length);
  for (let i = 0; i < uvs.length; i += 2) {
    const [x, y] = [map.film_mm[i]!, map.film_mm[i + 1]!];
    uvs[i] = Number.isNaN(x) ? 0 : x / film.width_mm + 0.5;
    uvs[i + 1] = Number.isNaN(y) ? 0 : y / film.height_mm + 0.5;
  }
  return uvs;
}

/** Vertex indices of the triangles with film (`wet`), and of those without film or with torn film (`bare`). */
function split(map: SurfaceMap): { wet: number[]; bare: number[] } {
  const wet: number[] = [];
  const bare: number[] = [];
  for (let i = 0; i < map.indices.length; i += 3) {
    const corners = [map.indices[i]!, map.indices[i + 1]!, map.indices[i + 2]!] as const;
    const isWhole = corners.every((a, k) => areNeighbours(map, a, corners[(k + 1) % 3]!));
    (isWhole ? wet : bare).push(...corners);
  }
  return { wet, bare };
}

// The film may gather to a quarter of its length. If two vertices are farther apart on the film than four times their
// distance on the object (plus 1 mm), the film between them is torn.
function areNeighbours(map: SurfaceMap, a: number, b: number): boolean {
  const apart = (of: Float32Array, size: number) => {
    let sum = 0;
    for (let k = 0; k < size; k += 1) sum += (of[size * a + k]! - of[size * b + k]!) ** 2;
    return Math.sqrt(sum);
  };
  return apart(map.film_mm, 2) <= 1 + 4 * apart(map.positions, 3);
}

/** Creates a texture with v pointing up, as in models. */
function textureOf(picture: ImageBitmap): Texture {
  const texture = new Texture(picture);
  // Browsers do not flip an ImageBitmap for WebGL, so the texture's transform flips it.
  texture.flipY = false;
  texture.matrixAutoUpdate = false;
  texture.matrix.set(1, 0, 0, 0, -1, 1, 0, 0, 1);
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  return texture;
}
