/** An error for display: what happened, and how to fix it. */
export interface Failure {
  what: string;
  remedy?: string;
  /** A stable reason code of the API (ErrorReason) or of this page, for use by code. */
  reason?: string;
  /** HTTP status; 0 if the daemon did not answer. */
  status?: number;
  /** The fields at fault. */
  violations?: readonly Violation[];
}

/** A field at fault (google.rpc.BadRequest.FieldViolation). */
export interface Violation {
  /** Its path: "simulate.dpi". */
  field: string;
  /** The problem, without the field. */
  description: string;
}

/** A value or a failure. */
export type Result<T> = { ok: true; value: T } | { ok: false; failure: Failure };

export const done = <T>(value: T): Result<T> => ({ ok: true, value });

export const refused = (
  what: string,
  remedy?: string,
  more?: Partial<Failure>,
): { ok: false; failure: Failure } => ({
  ok: false,
  failure: { what, ...(remedy ? { remedy } : {}), ...more },
});

/** The failure and its remedy as sentences without the last full stop. */
export const wordsOf = ({ what, remedy }: Failure): string =>
  remedy ? `${what}. ${remedy}` : what;

/** Thrown only inside parsers. `attempt` converts it to a Result. */
export class Refusal extends Error {
  constructor(
    readonly what: string,
    readonly remedy?: string,
  ) {
    super(what);
  }
}

/** Returns the value of `work`, or the failure if it throws a Refusal. */
export function attempt<T>(work: () => T): Result<T> {
  try {
    return done(work());
  } catch (error) {
    if (error instanceof Refusal) return refused(error.what, error.remedy);
    if (error instanceof RangeError)
      return refused(
        'the file is damaged or too large for this browser',
        'Export the model again, with fewer faces if it is very large',
      );
    throw error;
  }
}
