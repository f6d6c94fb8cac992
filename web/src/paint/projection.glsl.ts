/**
 * The projections as GLSL: from a point of the surface to a place on the picture. The functions use only what is also
 * valid in JavaScript once the types are removed, so that a unit test runs this text: arithmetic, components x, y and z,
 * `?:`, and vec2() and vec3() of numbers.
 */
export const kProjection = /* glsl */ `
// Where a picture is; see Placement. Points are in mm of frame O, relative to any common origin.
struct Place {
  vec3 position;
  vec3 right;
  vec3 up;
  vec3 ahead;
  float width;
  float height;
  float radius;
  float depth;
  float blend;
  float turn;
  float mirror;
};

float product(vec3 a, vec3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// The point relative to the picture's middle, along r, u and d.
vec3 seenPoint(Place place, vec3 point) {
  vec3 q = vec3(
    point.x - place.position.x, point.y - place.position.y, point.z - place.position.z
  );
  return vec3(product(q, place.right), product(q, place.up), product(q, place.ahead));
}

// The place on the picture (v up) of a point at (s, t) mm from its middle.
vec2 placeOnPicture(Place place, float s, float t) {
  float right = cos(place.turn) * s + sin(place.turn) * t;
  float up = cos(place.turn) * t - sin(place.turn) * s;
  return vec2(0.5 + place.mirror * right / place.width, 0.5 + up / place.height);
}

vec2 planarUv(Place place, vec3 point) {
  vec3 q = seenPoint(place, point);
  return placeOnPicture(place, q.x, q.y);
}

// The projection along axis 0, 1 or 2: r, u or d.
vec2 boxUv(Place place, vec3 point, int axis) {
  vec3 q = seenPoint(place, point);
  return placeOnPicture(place, axis == 0 ? q.z : q.x, axis == 1 ? q.z : q.y);
}

// The weight of an axis, before division by the sum of all.
float boxWeight(float distance, float blend) {
  float x = max(0.0, 1.0 - distance / blend);
  return x * x * (3.0 - 2.0 * x);
}

// An angle less whole turns, from -pi to pi.
float withoutTurns(float angle) {
  return angle - 6.283185307179586 * floor(angle / 6.283185307179586 + 0.5);
}

vec2 cylinderUv(Place place, vec3 point) {
  vec3 q = seenPoint(place, point);
  float angle = withoutTurns(atan(q.x, -q.z) - place.turn);
  return vec2(
    0.5 + place.mirror * angle * place.radius / place.width, 0.5 + q.y / place.height
  );
}

// The change of cylinderUv() for a small step from a point. Unlike its difference, it has no jump behind the object.
vec2 cylinderChange(Place place, vec3 point, vec3 change) {
  vec3 q = seenPoint(place, point);
  float right = product(change, place.right);
  float ahead = product(change, place.ahead);
  float angle = (q.x * ahead - q.z * right) / max(q.x * q.x + q.z * q.z, 1e-12);
  return vec2(
    place.mirror * angle * place.radius / place.width, product(change, place.up) / place.height
  );
}

// How much of a pixel is inside a decal, for one of its directions: places from -1/2 to 1/2 are inside.
// change: of the place, from one pixel to the next.
float insideDecal(float place, float change) {
  float inside = 0.5 - abs(place);
  return change > 0.0 ? clamp(inside / change + 0.5, 0.0, 1.0) : (inside >= 0.0 ? 1.0 : 0.0);
}
`;
