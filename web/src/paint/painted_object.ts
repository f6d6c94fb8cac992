/** A mesh with a paint, for a scene. Independent of the rest of the page. */
import { Mesh as Mesh3, type BufferGeometry, type Material, type WebGLRenderer } from 'three';
import { centreOf, type Box, type Look, type Mesh } from '../model/mesh';
import { kUpright, type Quaternion, type Vec3 } from '../model/pose';
import { findDistances } from '../worker/reader';
import { fineGeometry, geometryOf } from './geometry';
import { hitOf, type Hit } from './hit';
import { PaintLook, type PaintedMesh } from './material';
import type { Paint } from './paint';
import { distancesOf } from './shader';

/** What is shown. */
interface Content {
  mesh: Mesh;
  painted: PaintedMesh;
  scale: number;
  looks: Look[];
  /** The mesh as it is, without subdivision. */
  coarse: BufferGeometry;
}

export class PaintedObject {
  /** In units of the mesh's file. */
  readonly object = new Mesh3<BufferGeometry, Material[]>();
  private readonly look: PaintLook;
  private content: Content | undefined;
  private paint: Paint | undefined;
  private rotation: Quaternion = kUpright.rotation;
  /** The 'box' layers for which distances are needed, and those that the geometry has; as JSON. */
  private needed = '';
  private present = '';
  private work: Promise<void> | undefined;

  /**
   * @param onChange  called when the object has to be drawn again later than by the caller
   * @param isLit     false for the exact colours
   */
  constructor(
    private readonly renderer: WebGLRenderer,
    private readonly onChange: () => void,
    private readonly isLit = true,
  ) {
    this.look = new PaintLook(renderer);
    renderer.domElement.addEventListener('webglcontextrestored', this.restore);
  }

  /** `scale`: length of a unit, mm. */
  setMesh(mesh: Mesh, box: Box, scale: number): void {
    this.clear();
    const { positions, indices, uvs, colours } = mesh;
    this.content = {
      mesh,
      painted: { positions, indices, uvs, colours, scale, middle: centreOf(box) },
      scale,
      looks: mesh.parts.map(({ look }) => look),
      coarse: geometryOf(mesh),
    };
    this.object.geometry = this.content.coarse;
    this.update();
  }

  /** Shows a paint; undefined: the model's own look. */
  setPaint(paint: Paint | undefined): void {
    this.paint = paint;
    this.update();
  }

  /** The rotation from frame O to frame F at the start of the dip. */
  setRotation(rotation: Quaternion): void {
    if (rotation.every((value, i) => value === this.rotation[i])) return;
    this.rotation = rotation;
    if (this.paint?.layers.some(({ layer }) => layer.projection === 'dip')) this.update();
  }

  /** The point that a ray meets first; units of the mesh's file. */
  hit(from: Vec3, along: Vec3): Hit | undefined {
    return this.content && hitOf(this.content.mesh, from, along);
  }

  /** Resolves when nothing is being computed any more. */
  async settled(): Promise<void> {
    while (this.work) await this.work;
  }

  clear(): void {
    this.content?.coarse.dispose();
    this.object.geometry.dispose();
    this.dropMaterials();
    this.content = undefined;
    this.needed = this.present = '';
  }

  dispose(): void {
    this.renderer.domElement.removeEventListener('webglcontextrestored', this.restore);
    this.clear();
    this.look.dispose();
  }

  // The browser may drop what is on the GPU, for example while the page is in the background.
  private readonly restore = (): void => {
    this.look.forget();
    this.update();
    this.onChange();
  };

  private update(): void {
    if (!this.content) return;
    const { painted, looks } = this.content;
    if (!this.look.update(this.paint, painted, this.rotation, looks)) {
      this.dropMaterials();
      this.object.material = this.look.materials(this.isLit);
    }
    const boxes = this.look.boxes();
    this.needed = boxes.some((box) => box) ? JSON.stringify(boxes) : '';
    if (this.needed === '') this.show(this.content.coarse, '');
    this.markDistances();
    if (this.needed !== this.present) this.work ??= this.findDistances();
  }

  private dropMaterials(): void {
    for (const material of [this.object.material].flat()) material.dispose();
    this.object.material = [];
  }

  private show(geometry: BufferGeometry, boxes: string): void {
    const before = this.object.geometry;
    if (before !== geometry && before !== this.content?.coarse) before.dispose();
    this.object.geometry = geometry;
    this.present = boxes;
  }

  /** While new distances are computed, those before are shown. */
  private markDistances(): void {
    const { attributes } = this.object.geometry;
    this.look.setHasDistances(
      this.look.boxes().every((box, i) => !box || attributes[distancesOf(i)] !== undefined),
    );
  }

  private async findDistances(): Promise<void> {
    while (this.content && this.needed !== this.present) {
      const { content, needed } = this;
      const { positions, indices } = content.mesh;
      const surface = { positions: positions.map((x) => x * content.scale), indices };
      const fine = await findDistances(surface, this.look.boxes());
      if (this.content !== content || this.needed === '') continue;
      if (!fine) break;
      this.show(fineGeometry(content.coarse, fine, content.mesh.parts), needed);
      this.markDistances();
      this.onChange();
    }
    this.work = undefined;
  }
}
