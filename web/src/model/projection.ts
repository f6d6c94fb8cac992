/** The fields of a spec that project a single texture onto the object; see PaintLayer in spec.proto. */
export type ProjectionKind = 'uv' | 'planar' | 'dip' | 'cylindrical' | 'box' | 'decal';

/** The user's choices. The worker has a default for each: a fitted picture along the dip, if there are no UVs. */
export interface Projection {
  kind?: ProjectionKind | undefined;
  /** Width of the picture on the object. */
  size_mm?: number | undefined;
  /** Counter-clockwise, as seen by the viewer of the picture. */
  turn_deg?: number | undefined;
}

/** The projection's fields of a simulation's spec. */
export const projectionSpec = ({ kind, size_mm, turn_deg }: Projection) => ({
  ...(kind ? { project: kind } : {}),
  ...(size_mm ? { projectSizeMm: size_mm } : {}),
  ...(turn_deg ? { projectTurnDeg: turn_deg } : {}),
});

/** Inverse of projectionSpec. */
export const projectionOf = (spec: {
  project?: string;
  projectSizeMm?: number;
  projectTurnDeg?: number;
}): Projection => ({
  ...(spec.project ? { kind: spec.project as ProjectionKind } : {}),
  ...(spec.projectSizeMm ? { size_mm: spec.projectSizeMm } : {}),
  ...(spec.projectTurnDeg ? { turn_deg: spec.projectTurnDeg } : {}),
});
