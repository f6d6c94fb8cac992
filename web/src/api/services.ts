/** The API methods that the page uses. The .proto files in proto/hydroprint/v1 document their errors. */
import type { Result } from '../model/result';
import { randomId } from '../model/random_id';
import { address, call } from './call';
import type {
  ApiKey,
  Artifact,
  AuditEntry,
  Calibration,
  DepthPicture,
  Job,
  JobInput,
  JobReport,
  JobState,
  Lease,
  PlanProgress,
  Queue,
  Rig,
  Role,
  Session,
  SignedIn,
  User,
  WhoAmI,
} from './types';

type None = Record<string, never>;
type Page<K extends string, T> = Record<K, T[]> & { nextPageToken: string };

/** Creates a request_id, which makes a repeated request safe. */
export const newRequestId = (): string => randomId();

export const jobs = {
  list: (query: { owner?: string; states?: readonly JobState[]; pageToken?: string }) =>
    call<Page<'jobs', Job>>('GET', 'jobs', { query: { ...query, pageSize: 30 } }),
  get: (name: string) => call<Job>('GET', name),
  create: (job: JobInput, requestId: string, leaseId?: string) =>
    call<Job>('POST', 'jobs', { json: job, query: { requestId, leaseId } }),
  cancel: (name: string) => call<Job>('POST', `${name}:cancel`, { json: {} }),
  retry: (name: string, requestId: string) =>
    call<Job>('POST', `${name}:retry`, { json: { requestId } }),
  remove: (name: string) => call<None>('DELETE', name),
  share: (name: string, shared: boolean) =>
    call<Job>('POST', `${name}:share`, { json: { shared } }),
  moveToFront: (name: string, before: string) =>
    call<Job>('POST', `${name}:move`, { json: { before } }),
  confirm: (name: string, step: string, leaseId: string) =>
    call<Job>('POST', `${name}:confirm`, { json: { step, leaseId } }),
  planProgress: (plan: string) => call<PlanProgress>('GET', `${plan}/planProgress`),
  report: (name: string) => call<JobReport>('GET', `${name}/report`),
  artifacts: (name: string) =>
    call<Page<'artifacts', Artifact>>('GET', `${name}/artifacts`, { query: { pageSize: 1000 } }),
};

/** The path of an artifact's bytes, for `fetchBytes`. */
export const artifactPath = (job: string, file: string): string =>
  `${job}/artifacts/${file}:download`;

/** The URL of an artifact's bytes, for a link or an image. */
export const artifactAddress = (job: string, file: string, isInline = false): string =>
  address(artifactPath(job, file), isInline ? { inline: 1 } : {});

/** The URL of an image, by the name of its artifact: "jobs/7/artifacts/stretch-2.png". */
export const imageAddress = (artifact: string): string =>
  address(`${artifact}:download`, { inline: 1 });

export const queue = {
  get: () => call<Queue>('GET', 'queue'),
  pause: (reason: string) => call<Queue>('POST', 'queue:pause', { json: { reason } }),
  resume: () => call<Queue>('POST', 'queue:resume', { json: {} }),
};

export const calibrations = {
  list: () => call<Page<'calibrations', Calibration>>('GET', 'calibrations'),
};

export const rig = {
  get: () => call<Rig>('GET', 'rig'),
  /** Needs no lease and is never refused. The request is completed even if the page is closed. */
  stop: () => call<Rig>('POST', 'rig:stop', { json: {}, keepalive: true }),
  arm: (leaseId: string) => call<Rig>('POST', 'rig:arm', { json: { leaseId } }),
  disarm: (leaseId: string) => call<Rig>('POST', 'rig:disarm', { json: { leaseId } }),
  reset: (leaseId: string) => call<Rig>('POST', 'rig:resetFault', { json: { leaseId } }),
  home: (leaseId: string) =>
    call<Rig>('POST', 'rig:home', { json: { leaseId, requestId: newRequestId() } }),
  moveTo: (leaseId: string, positionMm: number, speedMmPerS?: number) =>
    call<Rig>('POST', 'rig:moveTo', {
      json: { leaseId, positionMm, speedMmPerS, requestId: newRequestId() },
    }),
  jog: (leaseId: string, speedMmPerS: number) =>
    call<Rig>('POST', 'rig:jog', { json: { leaseId, speedMmPerS } }),
};

export const camera = {
  picture: (signal: AbortSignal) => call<DepthPicture>('GET', 'camera/depthPicture', { signal }),
};

export const lease = {
  acquire: (purpose: string, ttl_s: number) =>
    call<Lease>('POST', 'rig/lease:acquire', { json: { purpose, ttl: `${ttl_s}s` } }),
  renew: (leaseId: string, ttl_s: number) =>
    call<Lease>('POST', 'rig/lease:renew', { json: { leaseId, ttl: `${ttl_s}s` } }),
  release: (leaseId: string) => call<None>('POST', 'rig/lease:release', { json: { leaseId } }),
  break: (reason: string) => call<None>('POST', 'rig/lease:break', { json: { reason } }),
};

export const session = {
  who: () => call<WhoAmI>('GET', 'session'),
  signIn: (by: { user: string; password: string } | { linkToken: string }) =>
    call<SignedIn>('POST', 'session:signIn', { json: by }),
  signOut: () => call<None>('POST', 'session:signOut', { json: {} }),
};

export const people = {
  users: () => call<Page<'users', User>>('GET', 'users', { query: { pageSize: 1000 } }),
  create: (user: { name: string; role: Role }, password: string) =>
    call<User>('POST', 'users', { json: { user, password } }),
  update: (name: string, change: { role?: Role; disabled?: boolean }) =>
    call<User>('PATCH', name, { json: change }),
  setPassword: (name: string, newPassword: string, oldPassword?: string) =>
    call<User>('POST', `${name}:setPassword`, { json: { newPassword, oldPassword } }),
  link: (name: string) =>
    call<{ token: string; expireTime: string }>('POST', `${name}:createSignInLink`, { json: {} }),
  remove: (name: string) => call<None>('DELETE', name),
  keys: () => call<Page<'apiKeys', ApiKey>>('GET', 'apiKeys', { query: { pageSize: 1000 } }),
  createKey: (displayName: string, role: Role, ttl_s?: number) =>
    call<{ apiKey: ApiKey; key: string }>('POST', 'apiKeys', {
      json: { displayName, role, ttl: ttl_s ? `${ttl_s}s` : undefined },
    }),
  sessions: () => call<Page<'sessions', Session>>('GET', 'sessions', { query: { pageSize: 1000 } }),
  audit: (query: { who?: string; what?: string; pageToken?: string }) =>
    call<Page<'entries', AuditEntry>>('GET', 'audit', { query: { ...query, pageSize: 50 } }),
  /** Deletes an API key or ends a session. */
  end: (name: string) => call<None>('DELETE', name),
};

export type Answer<T> = Promise<Result<T>>;
