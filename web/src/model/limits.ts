/** Applies the API's field rules (api/rules.ts) to form fields. */

export interface NumberRule {
  readonly min?: number;
  readonly max?: number;
  readonly unit?: string;
  readonly usual?: number;
}

/** Short forms of the API's units, for the pages. */
const kUnits: Readonly<Record<string, string>> = {
  degrees: '°',
  'degrees Celsius': '°C',
  'dots per inch': 'dpi',
};

/** Properties of a NumberField: unit, range, and the default value as its placeholder. */
export function limitsOf(rule: NumberRule) {
  const unit = rule.unit ?? '';
  return {
    unit: kUnits[unit] ?? unit,
    min: rule.min ?? -Infinity,
    max: rule.max ?? Infinity,
    ...(rule.usual === undefined ? {} : { placeholder: String(rule.usual) }),
  };
}

/** Truncates a text to at most `maxBytes` bytes of UTF-8 without splitting a character. */
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
