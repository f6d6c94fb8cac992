/**
 * The API's messages, generated from its OpenAPI document (schema.d.ts). Types named `...Input` are sent; the others are
 * received.
 */
import type { components } from './schema';

type Schemas = components['schemas'];

export type Job = Schemas['Job'];
export type JobInput = Schemas['JobInput'];
export type JobState = Job['state'];
export type JobEvent = Schemas['JobEvent'];
export type SimulateSpec = Schemas['SimulateSpec'];
export type SimulateSpecInput = Schemas['SimulateSpecInput'];
export type PlanSpec = Schemas['PlanSpec'];
export type PlanSpecInput = Schemas['PlanSpecInput'];
export type JobReport = Schemas['JobReport'];
export type FlowFacts = Schemas['FlowFacts'];
export type ModelSummary = Schemas['ModelSummary'];
export type Warning = Schemas['Warning'];
export type Place = Schemas['Place'];
export type PlanProgress = Schemas['PlanProgress'];
export type PlannedDip = Schemas['PlanProgress.Dip'];
export type DipSpecInput = Schemas['DipSpecInput'];
export type PrintImageSpecInput = Schemas['PrintImageSpecInput'];
export type InspectSpec = Schemas['InspectSpec'];
export type InputFile = Schemas['InputFile'];
export type Rig = Schemas['Rig'];
export type Lease = Schemas['Lease'];
export type Queue = Schemas['Queue'];
export type Artifact = Schemas['Artifact'];
export type Calibration = Schemas['Calibration'];
export type DepthPicture = Schemas['DepthPicture'];
export type Asset = Schemas['Asset'];
export type Upload = Schemas['Upload'];
export type Preview = Schemas['Preview'];
export type User = Schemas['User'];
export type Role = 'ROLE_UNSPECIFIED' | 'VIEWER' | 'MAKER' | 'OPERATOR' | 'ADMIN';
export type ApiKey = Schemas['ApiKey'];
export type Session = Schemas['Session'];
export type AuditEntry = Schemas['AuditEntry'];
export type WhoAmI = Schemas['WhoAmIResponse'];
export type SignedIn = Schemas['SignInResponse'];
