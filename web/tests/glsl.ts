/** Runs kProjection, the source text of the shader, as JavaScript. */
import { kProjection } from '../src/paint/projection.glsl';
import type { Placement } from '../src/paint/placement';
import type { Vec3 } from '../src/model/pose';

interface Vec2Value {
  x: number;
  y: number;
}
interface Vec3Value extends Vec2Value {
  z: number;
}
export type Place = Record<string, number | Vec3Value>;

export interface Functions {
  planarUv(place: Place, point: Vec3Value): Vec2Value;
  boxUv(place: Place, point: Vec3Value, axis: number): Vec2Value;
  cylinderUv(place: Place, point: Vec3Value): Vec2Value;
  cylinderChange(place: Place, point: Vec3Value, change: Vec3Value): Vec2Value;
  seenPoint(place: Place, point: Vec3Value): Vec3Value;
  boxWeight(distance: number, blend: number): number;
  insideDecal(place: number, change: number): number;
}

const kTypes = '(?:float|int|vec2|vec3|Place)';

/** Removes the types, and the struct. */
function scriptOf(glsl: string): string {
  return glsl
    .replace(/struct \w+ \{[^}]*\};/g, '')
    .replace(
      new RegExp(`^${kTypes} (\\w+)\\(([^)]*)\\)`, 'gm'),
      (_, name: string, list: string) => {
        const names = list.split(',').map((one) => one.trim().split(' ').at(-1));
        return `function ${name}(${names.join(', ')})`;
      },
    )
    .replace(new RegExp(`^( +)${kTypes} (\\w+) =`, 'gm'), '$1const $2 =');
}

const kBuiltIn = `
const { cos, sin, floor, abs, max } = Math;
const atan = Math.atan2;
const clamp = (x, low, high) => Math.min(high, Math.max(low, x));
const vec2 = (x, y) => ({ x, y });
const vec3 = (x, y, z) => ({ x, y, z });
`;
const kNames = [...kProjection.matchAll(/^\w+ (\w+)\(/gm)].map((match) => match[1]!);

export const glsl = new Function(
  `${kBuiltIn}${scriptOf(kProjection)}return { ${kNames.join(', ')} };`,
)() as Functions;

export const vec = ([x, y, z]: Vec3): Vec3Value => ({ x, y, z });

/** The uniform of a placement, for points of frame O. */
export const placeOf = (at: Placement): Place => ({
  position: vec(at.position_mm),
  right: vec(at.right),
  up: vec(at.up),
  ahead: vec(at.direction),
  width: at.width_mm,
  height: at.height_mm,
  radius: at.radius_mm,
  depth: at.depth_mm,
  blend: at.blend_mm,
  turn: at.turn_rad,
  mirror: at.mirror ? -1 : 1,
});
