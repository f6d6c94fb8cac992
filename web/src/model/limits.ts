/** What the API's rules (api/rules.ts) mean for a form's fields. */

export interface NumberRule {
  readonly min?: number;
  readonly max?: number;
  readonly unit?: string;
  readonly usual?: number;
}

/** As people on the pages write them, where that is shorter. */
const kUnits: Readonly<Record<string, string>> = {
  'degrees Celsius': '°C',
  'dots per inch': 'dpi',
};

/** For a NumberField: its unit, its range, and its default as the placeholder. */
export function limitsOf(rule: NumberRule) {
  const unit = rule.unit ?? '';
  return {
    unit: kUnits[unit] ?? unit,
    min: rule.min ?? -Infinity,
    max: rule.max ?? Infinity,
    ...(rule.usual === undefined ? {} : { placeholder: String(rule.usual) }),
  };
}

/** The beginning of a text that takes at most so many bytes of UTF-8; no character is cut in two. */
export function cutToBytes(text: string, maxBytes: number): string {
  const encoder = new TextEncoder();
  let out = '';
  let bytes = 0;
  for (const character of text) {
    bytes += encoder.encode(character).length;
    if (bytes > maxBytes) return out;
    out += character;
  }
  return out;
}
