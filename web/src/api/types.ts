/** The API's messages, as generated from its OpenAPI document (schema.d.ts). */
import type { components } from './schema';

type Schemas = components['schemas'];
/** proto3 JSON always has these fields. */
type With<T, K extends keyof T> = T & { [P in K]-?: NonNullable<T[P]> };

export type Job = With<
  Schemas['Job'],
  'name' | 'displayName' | 'owner' | 'state' | 'progressFraction' | 'phase' | 'priority'
>;
export type JobState = Job['state'];
export type JobEvent = Schemas['JobEvent'];
export type DipStatus = Schemas['DipStatus'];
export type SimulateSpec = Schemas['SimulateSpec'];
export type DipSpec = Schemas['DipSpec'];
export type InputFile = With<Schemas['InputFile'], 'name' | 'asset'>;
export type Rig = With<Schemas['Rig'], 'state' | 'homed' | 'trouble' | 'cause' | 'dip'>;
export type Lease = With<Schemas['Lease'], 'holder' | 'purpose'>;
export type Queue = With<Schemas['Queue'], 'paused' | 'queuedJobs' | 'runningJobs' | 'queuedCount'>;
export type Artifact = With<Schemas['Artifact'], 'name' | 'sizeBytes' | 'mediaType'>;
export type Calibration = With<Schemas['Calibration'], 'name' | 'displayName' | 'kind' | 'active'>;
export type Asset = With<Schemas['Asset'], 'name'>;
export type Upload = With<Schemas['Upload'], 'name' | 'receivedBytes' | 'sizeBytes'>;
export type User = With<Schemas['User'], 'name' | 'role'>;
export type Role = NonNullable<Schemas['User']['role']>;
export type ApiKey = With<Schemas['ApiKey'], 'name' | 'user'>;
export type Session = With<Schemas['Session'], 'name' | 'user'>;
export type AuditEntry = Schemas['AuditEntry'];
export type WhoAmI = With<Schemas['WhoAmIResponse'], 'user' | 'role' | 'csrfToken' | 'accounts'>;
export type SignedIn = With<Schemas['SignInResponse'], 'csrfToken'>;
export type Preview = Schemas['Preview'];
