// Writes what the OpenAPI document declares of fields that are sent (ranges, lengths, units, defaults) as a module.
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

// What goes both ways is declared as it is sent ("JobInput") and as it is answered ("Job").
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
