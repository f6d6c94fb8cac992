/**
 * The common part of both 3D views: camera, light, the film at true size in the plane z = 0, and the water below it;
 * mm, z up. Renders only when something changes. Independent of the rest of the page.
 */
import {
  AmbientLight,
  BufferGeometry,
  CircleGeometry,
  Color,
  DirectionalLight,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  LineBasicMaterial,
  LineLoop,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Shape,
  ShapeGeometry,
  Vector3,
  WebGLRenderer,
  type Material,
  type Object3D,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Film } from '../model/film';

export type Side = 'corner' | 'front' | 'right' | 'top' | 'below';

const kFrom: Record<Side, readonly [number, number, number]> = {
  corner: [0.55, -1, 0.55],
  front: [0, -1, 0.02],
  right: [1, 0, 0.02],
  top: [0, -0.001, 1],
  below: [0, -0.001, -1],
};

export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(35, 1, 1, 20_000);
  readonly renderer: WebGLRenderer;
  readonly controls: OrbitControls;
  private readonly film = new Group();
  private readonly watch: ResizeObserver;
  private isAsked = false;
  private reach_mm = 200;

  /** @throws Error if the browser has no WebGL */
  constructor(private readonly host: HTMLElement) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    host.append(this.renderer.domElement);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.draw());
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(0.4, 0.6, 1);
    this.camera.add(sun);
    this.scene.add(this.camera, new AmbientLight(0xffffff, 1.1), this.film);
    this.watch = new ResizeObserver(() => this.resize());
    this.watch.observe(host);
    this.resize();
  }

  /** Shows the film and the water around it. */
  setFilm(film: Film): void {
    disposeOf(this.film);
    this.film.clear();
    this.film.add(waterAround(film), sheetOf(film), linesOn(film), outlineOf(film), topOf(film));
    this.draw();
  }

  /** Looks from that side so that everything within `reach_mm` of `centre` is visible. */
  look(side: Side, reach_mm = this.reach_mm, centre = new Vector3()): void {
    this.reach_mm = reach_mm;
    this.lookFrom(new Vector3(...kFrom[side]), reach_mm, centre);
  }

  /** Comes so near, without turning, that everything within `reach_mm` of `centre` is just visible. */
  approach(reach_mm: number, centre: Vector3): void {
    this.lookFrom(this.camera.position.clone().sub(this.controls.target), reach_mm, centre);
  }

  private lookFrom(direction: Vector3, reach_mm: number, centre: Vector3): void {
    this.camera.position
      .copy(centre)
      .addScaledVector(direction.normalize(), this.distanceFor(reach_mm));
    this.controls.target.copy(centre);
    this.controls.update();
    this.draw();
  }

  private distanceFor(reach_mm: number): number {
    const wide = Math.min(1, this.camera.aspect);
    return reach_mm / Math.sin((this.camera.fov * Math.PI) / 360) / wide;
  }

  /**
   * Draws what is within `reach_mm` of `centre`, seen from the corner, into a square canvas. Must be followed by
   * `drawNow`, before the browser shows the stage.
   */
  portray(canvas: HTMLCanvasElement, reach_mm: number, centre: Vector3): void {
    const { domElement } = this.renderer;
    const side = Math.min(domElement.width, domElement.height);
    const context = canvas.getContext('2d');
    if (!context || side === 0) return;
    const { position, quaternion } = this.camera.clone();
    const direction = new Vector3(...kFrom.corner).normalize();
    this.camera.position.copy(centre).addScaledVector(direction, this.distanceFor(reach_mm));
    this.camera.lookAt(centre);
    this.drawNow();
    this.camera.position.copy(position);
    this.camera.quaternion.copy(quaternion);
    const [x, y] = [(domElement.width - side) / 2, (domElement.height - side) / 2];
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(domElement, x, y, side, side, 0, 0, canvas.width, canvas.height);
  }

  drawNow(): void {
    this.renderer.render(this.scene, this.camera);
  }

  /** Renders once, in the next frame. */
  draw(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.drawNow();
    });
  }

  dispose(): void {
    this.watch.disconnect();
    this.controls.dispose();
    disposeOf(this.scene);
    this.renderer.dispose();
    this.renderer.domElement.remove();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}

/** Frees the GPU resources of all objects below `root`. */
export function disposeOf(root: Object3D): void {
  root.traverse((child) => {
    const { geometry, material } = child as Partial<Mesh>;
    geometry?.dispose();
    for (const one of [material ?? []].flat() as Material[]) {
      (one as { map?: { dispose(): void } | null }).map?.dispose();
      one.dispose();
    }
  });
}

const kWater = new Color(0x4b93b5);
const kSheet = new Color(0xffffff);

function sheetOf(film: Film): Object3D {
  const geometry = film.radius_mm
    ? new CircleGeometry(film.radius_mm, 96)
    : new PlaneGeometry(film.width_mm, film.height_mm);
  const material = new MeshBasicMaterial({
    color: kSheet,
    transparent: true,
    opacity: 0.55,
    side: DoubleSide,
    depthWrite: false,
  });
  return new Mesh(geometry, material);
}

function waterAround(film: Film): Object3D {
  const geometry = new PlaneGeometry(1.35 * film.width_mm, 1.25 * film.height_mm);
  const material = new MeshBasicMaterial({
    color: kWater,
    transparent: true,
    opacity: 0.22,
    side: DoubleSide,
    depthWrite: false,
  });
  const water = new Mesh(geometry, material);
  water.position.z = -0.4;
  water.renderOrder = -1;
  return water;
}

function outlineOf(film: Film): Object3D {
  const points: number[] = [];
  if (film.radius_mm) {
    for (let i = 0; i < 96; i += 1) {
      const angle = (2 * Math.PI * i) / 96;
      points.push(film.radius_mm * Math.cos(angle), film.radius_mm * Math.sin(angle), 0);
    }
  } else {
    const [x, y] = [film.width_mm / 2, film.height_mm / 2];
    points.push(-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0);
  }
  return new LineLoop(lineGeometry(points), new LineBasicMaterial({ color: 0x0b6e99 }));
}

/** A grid with one line every 10 mm. */
function linesOn(film: Film): Object3D {
  const points: number[] = [];
  const halfAt = (at: number, half: number) =>
    film.radius_mm ? Math.sqrt(Math.max(0, film.radius_mm ** 2 - at ** 2)) : half;
  const [halfX, halfY] = [film.width_mm / 2, film.height_mm / 2];
  for (let x = -Math.floor(halfX / 10) * 10; x <= halfX; x += 10) {
    const end = halfAt(x, halfY);
    points.push(x, -end, 0, x, end, 0);
  }
  for (let y = -Math.floor(halfY / 10) * 10; y <= halfY; y += 10) {
    const end = halfAt(y, halfX);
    points.push(-end, y, 0, end, y, 0);
  }
  const material = new LineBasicMaterial({ color: 0x6b8591, transparent: true, opacity: 0.3 });
  return new LineSegments(lineGeometry(points), material);
}

/** An arrow beyond the film's top edge, which shows the film's orientation. */
function topOf(film: Film): Object3D {
  const y = film.height_mm / 2 + 4;
  const shape = new Shape();
  shape
    .moveTo(-7, y)
    .lineTo(7, y)
    .lineTo(0, y + 11);
  const material = new MeshBasicMaterial({ color: 0x0b6e99, side: DoubleSide });
  return new Mesh(new ShapeGeometry(shape), material);
}

function lineGeometry(points: number[]): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(points, 3));
  return geometry;
}
