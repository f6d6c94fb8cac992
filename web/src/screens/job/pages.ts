import type { Job, PrintImageSpecInput } from '../../api/types';

/** The print-image spec of a simulation, with the paper and colours that were chosen on the New print page. */
export function pagesOf({
  name,
  displayName,
  labels,
}: Pick<Job, 'name' | 'displayName' | 'labels'>): PrintImageSpecInput {
  const { paper, colours } = labels;
  return {
    simulateJob: name,
    jobName: displayName,
    ...(paper ? { paper } : {}),
    ...(colours === 'COLOURS_CMYK' ? { colours } : {}),
  };
}
