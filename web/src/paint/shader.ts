/** The shader's source text for a list of layers. */
import type { ProjectionName } from './layer';
import { kProjection } from './projection.glsl';

/** What the source text of a layer depends on. Everything else is a uniform. */
export interface LayerKind {
  projection: ProjectionName;
  /** 'own': the model's own colours, for 'uv'. */
  shows: 'picture' | 'colour' | 'own';
}

/** Name of the attribute with a vertex's distances to the axes of layer `i` ('box'). */
export const distancesOf = (i: number): string => `distances${i}`;

const isBox = ({ projection, shows }: LayerKind): boolean =>
  projection === 'box' && shows === 'picture';
const count = <T>(list: readonly T[], text: (one: T, i: number) => string): string =>
  list.map(text).join('\n');

/** Declarations before main() of the vertex shader. */
export const vertexHead = (kinds: readonly LayerKind[]): string => /* glsl */ `
uniform vec3 paintMiddle;
uniform float paintScale;
attribute vec3 ownColour;
varying vec3 vPoint;
varying vec2 vPaintUv;
varying vec3 vOwnColour;
${count(kinds, (kind, i) => (isBox(kind) ? `attribute vec3 ${distancesOf(i)}; varying vec3 vDistances${i};` : ''))}
`;

/** Statements of main() of the vertex shader. */
export const vertexBody = (kinds: readonly LayerKind[]): string => /* glsl */ `
vPoint = (position - paintMiddle) * paintScale;
vPaintUv = uv;
vOwnColour = ownColour;
${count(kinds, (kind, i) => (isBox(kind) ? `vDistances${i} = ${distancesOf(i)};` : ''))}
`;

// Colours are in linear light. Pictures have premultiplied alpha: (a p, a).
const kFragmentHead = /* glsl */ `
varying vec3 vPoint;
varying vec2 vPaintUv;
varying vec3 vOwnColour;
uniform vec3 baseColour;
uniform vec3 ownTint;
uniform sampler2D ownPicture;
uniform bool hasOwnPicture;
uniform bool hasOwnColours;
uniform bool hasDistances;

// Cosines of angles between a triangle and the direction of view below this count as 0: differences between pixels have
// rounding errors.
const float kEdgeOn = 1e-3;
// Difference of cosines below which two axes are equally near.
const float kEqual = 1e-4;

vec3 flatNormal() {
  vec3 normal = normalize(cross(dFdx(vPoint), dFdy(vPoint)));
  return gl_FrontFacing ? normal : -normal;
}

// The model's own colours. Transparent textures are shown over white.
vec3 ownLook() {
  vec3 tint = hasOwnColours ? ownTint * vOwnColour : ownTint;
  if (!hasOwnPicture) return tint;
  vec4 texel = texture2D(ownPicture, vPaintUv);
  return tint * texel.rgb + (1.0 - texel.a);
}

vec4 planarPicture(sampler2D picture, Place place) {
  return texture2D(picture, planarUv(place, vPoint));
}

vec4 cylinderPicture(sampler2D picture, Place place) {
  vec2 toRight = cylinderChange(place, vPoint, dFdx(vPoint));
  vec2 toUp = cylinderChange(place, vPoint, dFdy(vPoint));
  return textureGrad(picture, cylinderUv(place, vPoint), toRight, toUp);
}

// The weights of the axes as long as the distances are not known.
vec3 nearestAxis(Place place) {
  vec3 normal = flatNormal();
  vec3 cosines = abs(
    vec3(product(normal, place.right), product(normal, place.up), product(normal, place.ahead))
  );
  if (cosines.z > max(cosines.x, cosines.y) + kEqual) return vec3(0.0, 0.0, 1.0);
  return cosines.y > cosines.x + kEqual ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
}

vec4 boxPicture(sampler2D picture, Place place, vec3 distances) {
  vec3 weights = vec3(
    boxWeight(distances.x, place.blend),
    boxWeight(distances.y, place.blend),
    boxWeight(distances.z, place.blend)
  );
  float sum = weights.x + weights.y + weights.z;
  weights = hasDistances && sum > 0.0 ? weights / sum : nearestAxis(place);
  return weights.x * texture2D(picture, boxUv(place, vPoint, 0)) +
    weights.y * texture2D(picture, boxUv(place, vPoint, 1)) +
    weights.z * texture2D(picture, boxUv(place, vPoint, 2));
}

float decalShare(Place place) {
  vec2 uv = planarUv(place, vPoint);
  float depth = place.depth > 0.0 ? seenPoint(place, vPoint).z / place.depth : 0.0;
  float share = insideDecal(uv.x - 0.5, fwidth(uv.x)) * insideDecal(uv.y - 0.5, fwidth(uv.y)) *
    insideDecal(depth, fwidth(depth));
  return product(flatNormal(), place.ahead) < -kEdgeOn ? share : 0.0;
}

vec3 over(vec3 below, vec4 layer, float share) {
  return below + share * (layer.rgb - layer.a * below);
}
`;

const uniforms = (kind: LayerKind, i: number): string => /* glsl */ `
uniform Place place${i};
uniform float opacity${i};
uniform vec3 colour${i};
${kind.shows === 'picture' ? `uniform sampler2D picture${i};` : ''}
${isBox(kind) ? `varying vec3 vDistances${i};` : ''}
`;

/** An expression for a layer's colour. */
function colour({ projection, shows }: LayerKind, i: number): string {
  if (projection === 'vertex_colors') return 'vec4(vOwnColour, 1.0)';
  if (shows === 'own') return 'vec4(ownLook(), 1.0)';
  if (shows === 'colour') return `vec4(colour${i}, 1.0)`;
  if (projection === 'uv') return `texture2D(picture${i}, vPaintUv)`;
  if (projection === 'cylindrical') return `cylinderPicture(picture${i}, place${i})`;
  if (projection === 'box') return `boxPicture(picture${i}, place${i}, vDistances${i})`;
  return `planarPicture(picture${i}, place${i})`;
}

function addition(kind: LayerKind, i: number): string {
  const share = kind.projection === 'decal' ? `opacity${i} * decalShare(place${i})` : `opacity${i}`;
  return `colour = over(colour, ${colour(kind, i)}, ${share});`;
}

/** Declarations before main() of the fragment shader, with `vec3 paintedColour()`. */
export const fragmentHead = (kinds: readonly LayerKind[]): string => /* glsl */ `
${kProjection}
${kFragmentHead}
${count(kinds, uniforms)}
vec3 paintedColour() {
  vec3 colour = baseColour;
  ${count(kinds, addition)}
  return colour;
}
`;
