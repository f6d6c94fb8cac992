// Writes a module with the rules of request fields (ranges, lengths, units, defaults) from the OpenAPI document.
// Usage: node rules.mjs openapi.json rules.ts
import { readFileSync, writeFileSync } from 'node:fs';

const [document, out] = process.argv.slice(2);
const { schemas } = JSON.parse(readFileSync(document, 'utf8')).components;

const kKeywords = {
  min: 'minimum',
  max: 'maximum',
  maxBytes: 'maxLength',
  unit: 'x-unit',
  usual: 'default',
};

const ruleOf = (property) =>
  Object.fromEntries(
    Object.entries(kKeywords)
      .filter(([, keyword]) => keyword in property)
      .map(([name, keyword]) => [name, property[keyword]]),
  );

// Messages that are both sent and received have two schemas, such as "JobInput" (sent) and "Job" (received).
const isSent = (name) => !(`${name}Input` in schemas);

let module = "// Written by rules.mjs from the daemon's OpenAPI document.\n";
for (const [name, { properties }] of Object.entries(schemas)) {
  if (!isSent(name)) continue;
  const fields = Object.entries(properties ?? {})
    .map(([field, property]) => [field, ruleOf(property)])
    .filter(([, rule]) => Object.keys(rule).length > 0);
  if (fields.length === 0) continue;
  const value = JSON.stringify(Object.fromEntries(fields), null, 2);
  module += `export const ${name.replace(/Input$/, '').replaceAll('.', '_')} = ${value} as const;\n`;
}

writeFileSync(out, module);
