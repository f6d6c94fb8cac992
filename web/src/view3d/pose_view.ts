/** 3D view of the object over the film. The user can rotate and move the object. */
import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  Group,
  Mesh as Mesh3,
  MeshStandardMaterial,
  Quaternion as Quaternion3,
  Raycaster,
  Vector2,
  Vector3,
} from 'three';
import { TransformControls } from 'three/addons/controls/TransformControls.js';
import type { Film } from '../model/film';
import { centreOf, type Box, type Mesh } from '../model/mesh';
import { rotate, type Pose, type Vec3 } from '../model/pose';
import type { Paint } from '../paint/paint';
import { PaintedObject } from '../paint/painted_object';
import { Stage, disposeOf, type Side } from './stage';

/** A point of the object's surface, with the outward normal (length 1) of its triangle; frame O. */
export interface SurfacePoint {
  point_mm: Vec3;
  normal: Vec3;
}

export type Gizmo = 'none' | 'rotate' | 'translate';

export interface Events {
  /** Called while the user rotates or moves the object. */
  onPose: (pose: Pose) => void;
  /** Called when the object or its paint has changed. */
  onLook: () => void;
}

export class PoseView {
  private readonly stage: Stage;
  // Its origin is the centre of the object's bounding box, about which the object rotates.
  private readonly holder = new Group();
  private readonly gizmo: TransformControls;
  private readonly painted: PaintedObject;
  private heat = new Mesh3();
  private box: Box = { min: [0, 0, 0], max: [0, 0, 0] };
  private positions = new Float32Array();
  private scale = 1;

  constructor(
    host: HTMLElement,
    private readonly events: Events,
  ) {
    this.stage = new Stage(host);
    this.painted = new PaintedObject(this.stage.renderer, () => this.changeLook());
    this.gizmo = new TransformControls(this.stage.camera, this.stage.renderer.domElement);
    this.gizmo.setSpace('world');
    this.gizmo.attach(this.holder);
    this.gizmo.addEventListener('change', () => this.stage.draw());
    this.gizmo.addEventListener('dragging-changed', (event) => {
      this.stage.controls.enabled = !event.value;
    });
    this.gizmo.addEventListener('objectChange', () => this.emitPose());
    this.stage.scene.add(this.holder, this.gizmo.getHelper());
    this.setGizmo('rotate');
  }

  setFilm(film: Film): void {
    this.stage.setFilm(film);
  }

  /** Shows a mesh. Must be followed by `setPose`. */
  setMesh(mesh: Mesh, box: Box, scale: number): void {
    this.clear();
    this.box = box;
    this.scale = scale;
    this.positions = new Float32Array(mesh.positions);
    this.painted.setMesh(mesh, box, scale);
    const { object } = this.painted;
    object.position.copy(this.originOfO());
    object.scale.setScalar(scale);
    this.holder.add(object);
    this.changeLook();
  }

  /**
   * Shows a paint on the object, on this mesh and later ones; without one, the model's own look. Fast unless the layers
   * change in number, kind, or pictures, so it may be called while the user drags.
   */
  setPaint(paint: Paint | undefined): void {
    this.painted.setPaint(paint);
    this.changeLook();
  }

  /** The point of the object at a place on the screen (`clientX`, `clientY` of a pointer event), if there is one. */
  hit(clientX: number, clientY: number): SurfacePoint | undefined {
    const { object } = this.painted;
    const canvas = this.stage.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(
      (2 * (clientX - canvas.left)) / canvas.width - 1,
      1 - (2 * (clientY - canvas.top)) / canvas.height,
    );
    const raycaster = new Raycaster();
    raycaster.setFromCamera(at, this.stage.camera);
    object.updateWorldMatrix(true, false);
    const ray = raycaster.ray.applyMatrix4(object.matrixWorld.clone().invert());
    const hit = this.painted.hit(ray.origin.toArray(), ray.direction.toArray());
    if (!hit) return undefined;
    const [x, y, z] = hit.point;
    return { point_mm: [x * this.scale, y * this.scale, z * this.scale], normal: hit.normal };
  }

  /** Stops the camera and the gizmo from following the pointer, while the user drags something else. */
  holdCamera(isHeld: boolean): void {
    this.stage.controls.enabled = !isHeld;
    this.gizmo.enabled = !isHeld && this.gizmo.getHelper().visible;
  }

  /** Shows a coloured mesh (object's frame, mm) instead of the textured object; without one, the textured object. */
  setHeat(heat?: { positions: Float32Array; corners: Uint32Array; colours: Uint8Array }): void {
    this.holder.remove(this.heat);
    disposeOf(this.heat);
    this.painted.object.visible = heat === undefined;
    if (heat) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(heat.positions, 3));
      geometry.setAttribute('color', new BufferAttribute(heat.colours, 3, true));
      geometry.setIndex(new BufferAttribute(heat.corners, 1));
      geometry.computeVertexNormals();
      this.heat = new Mesh3(
        geometry,
        new MeshStandardMaterial({ roughness: 0.9, side: DoubleSide, vertexColors: true }),
      );
      this.heat.position.copy(this.originOfO());
      this.holder.add(this.heat);
    }
    this.stage.draw();
  }

  clear(): void {
    this.painted.clear();
    disposeOf(this.heat);
    this.holder.clear();
    this.positions = new Float32Array();
    this.stage.draw();
  }

  setPose(pose: Pose): void {
    this.place(pose);
    this.stage.draw();
  }

  /** Draws the painted object in other poses into canvases. What the view shows stays. */
  portray(pictures: readonly { pose: Pose; canvas: HTMLCanvasElement }[]): void {
    const shown = this.poseOfHolder();
    const { object } = this.painted;
    const others = [this.gizmo.getHelper(), this.heat, object];
    const before = others.map(({ visible }) => visible);
    others.forEach((other) => (other.visible = other === object));
    for (const { pose, canvas } of pictures) {
      this.place(pose);
      this.stage.portray(canvas, 0.48 * this.size_mm().length(), this.holder.position);
    }
    others.forEach((other, k) => (other.visible = before[k]!));
    this.place(shown);
    this.stage.drawNow();
  }

  setGizmo(gizmo: Gizmo): void {
    const helper = this.gizmo.getHelper();
    helper.visible = gizmo !== 'none';
    this.gizmo.enabled = gizmo !== 'none';
    if (gizmo !== 'none') this.gizmo.setMode(gizmo);
    this.gizmo.showZ = gizmo === 'rotate';
    this.stage.draw();
  }

  /** Shows the whole object and film from that side. */
  look(side: Side, film: Film): void {
    const size = this.size_mm();
    const reach = Math.max(0.55 * Math.hypot(film.width_mm, film.height_mm), 0.7 * size.length());
    this.stage.look(side, reach, new Vector3(0, 0, Math.min(size.length() / 3, reach / 2)));
  }

  /** Shows the object alone, from the same side. */
  closeUp(): void {
    this.stage.approach(0.6 * this.size_mm().length(), this.holder.position);
  }

  dispose(): void {
    this.gizmo.dispose();
    this.painted.dispose();
    this.stage.dispose();
  }

  private size_mm(): Vector3 {
    return new Vector3(
      this.box.max[0] - this.box.min[0],
      this.box.max[1] - this.box.min[1],
      this.box.max[2] - this.box.min[2],
    ).multiplyScalar(this.scale);
  }

  /** The origin of frame O, relative to the centre of the bounding box. */
  private originOfO(): Vector3 {
    const [x, y, z] = centreOf(this.box);
    return new Vector3(x, y, z).multiplyScalar(-this.scale);
  }

  private changeLook(): void {
    this.stage.draw();
    this.events.onLook();
  }

  private place(pose: Pose): void {
    const [w, x, y, z] = pose.rotation;
    this.holder.quaternion.copy(new Quaternion3(x, y, z, w));
    this.painted.setRotation(pose.rotation);
    this.holder.position.set(pose.centre_mm[0], pose.centre_mm[1], this.heightFor(pose));
  }

  private poseOfHolder(): Pose {
    const { quaternion, position } = this.holder;
    const { x, y, z, w } = quaternion;
    return { rotation: [w, x, y, z], centre_mm: [position.x, position.y] };
  }

  private emitPose(): void {
    const pose = this.poseOfHolder();
    this.holder.position.z = this.heightFor(pose);
    this.painted.setRotation(pose.rotation);
    this.events.onPose(pose);
  }

  /** Height of the box's centre over the water when the lowest point touches the water. */
  private heightFor(pose: Pose): number {
    return -lowest(this.positions, centreOf(this.box), pose) * this.scale;
  }
}

/** z of the lowest point relative to `centre` after the rotation. */
function lowest(positions: Float32Array, centre: Vec3, pose: Pose): number {
  // The third row of the rotation matrix: the upward component of each of the object's axes.
  const ups = (
    [
      [1, 0, 0],
      [0, 1, 0],
      [0, 0, 1],
    ] as const
  ).map((axis) => rotate(pose.rotation, axis)[2]);
  const [ux, uy, uz] = [ups[0]!, ups[1]!, ups[2]!];
  let least = 0;
  for (let i = 0; i < positions.length; i += 3) {
    const z =
      ux * (positions[i]! - centre[0]) +
      uy * (positions[i + 1]! - centre[1]) +
      uz * (positions[i + 2]! - centre[2]);
    if (z < least) least = z;
  }
  return least;
}
