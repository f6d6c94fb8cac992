/** What went wrong, in words for people: what happened, and what to do. */
export interface Failure {
  what: string;
  remedy?: string;
  /** Stable word of the API (ErrorReason), or of this page; programs may look at it. */
  reason?: string;
  /** HTTP status; 0 if the daemon did not answer. */
  status?: number;
  /** What the API says besides (google.rpc.ErrorInfo.metadata). */
  metadata?: Record<string, string>;
}

/** A value, or why there is none. */
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

/** Thrown inside a parser alone; `attempt` turns it into a Result at its door. */
export class Refusal extends Error {
  constructor(
    readonly what: string,
    readonly remedy?: string,
  ) {
    super(what);
  }
}

/** The value of `work`, or the failure that a Refusal in it told. */
export function attempt<T>(work: () => T): Result<T> {
  try {
    return done(work());
  } catch (error) {
    if (error instanceof Refusal) return refused(error.what, error.remedy);
    if (error instanceof RangeError)
      return refused('the file is damaged or too large for this browser', 'Export it again');
    throw error;
  }
}
