"""Checks the OpenAPI document that a program prints: by the OpenAPI Initiative's own schema, for what that schema cannot
say, and against requests and answers as they are. Usage: check_openapi.py DOCUMENT_PROGRAM SAMPLES_PROGRAM"""
import copy
import json
import re
import subprocess
import sys
import urllib.parse

import jsonschema

SCHEMA = "/usr/share/openapi-specification/schemas/v3.0/schema.json"
METHODS = {"get", "put", "post", "delete", "patch", "head"}
BY_HAND = {"GetHealth", "GetMetrics", "GetOpenApi", "DownloadArtifact", "HeadArtifact", "HeadUpload", "PatchUpload"}


def output_of(program):
    return subprocess.run([program], check=True, stdout=subprocess.PIPE).stdout.decode()


def without_repeats(pairs):
    names = [name for name, _ in pairs]
    assert len(names) == len(set(names)), f"a name is there twice among {names}"
    return dict(pairs)


def everything_in(node, place=""):
    yield place, node
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else []
    for key, value in items:
        yield from everything_in(value, f"{place}/{key}")


def operations_of(document):
    for path, item in document["paths"].items():
        for method, operation in item.items():
            yield path, method, operation


def wrong_form(document):
    with open(SCHEMA, encoding="utf-8") as file:
        schema = json.load(file)
    for error in jsonschema.Draft4Validator(schema).iter_errors(document):
        yield f"{list(error.absolute_path)}: {error.message[:500]}"


def wrong_references(document):
    components = document["components"]
    known = {f"#/components/{kind}/{name}" for kind, named in components.items() for name in named}
    used = {"#/components/responses/Error"}
    for place, node in everything_in(document):
        if not isinstance(node, dict):
            continue
        if isinstance(node.get("$ref"), str):
            used.add(node["$ref"])
            if len(node) > 1:
                yield f"{place}: what stands beside $ref counts for nothing"
        for name in node.get("required", []) if "properties" in node else []:
            if name not in node["properties"]:
                yield f"{place}: requires {name}, which it does not have"
    for name in used ^ known:
        yield f"{name} leads nowhere, or nothing leads there"


def wrong_operations(document):
    names = [operation["operationId"] for _, _, operation in operations_of(document)]
    if len(names) != len(set(names)):
        yield f"two operations have the same name: {sorted(names)}"
    for path, method, operation in operations_of(document):
        if method not in METHODS:
            yield f"{path}: {method} is no HTTP method"
        parameters = [(p["in"], p["name"]) for p in operation.get("parameters", [])]
        if len(parameters) != len(set(parameters)):
            yield f"{method} {path}: a parameter is there twice"
        declared = {name for place, name in parameters if place == "path"}
        if declared != set(re.findall(r"{([^}]*)}", path)):
            yield f"{method} {path}: declares {declared}"
        if not operation.get("summary"):
            yield f"{method} {path}: says nothing of itself"
    shapes = [re.sub(r"{[^}]*}", "{}", path) for path in document["paths"]]
    if len(shapes) != len(set(shapes)):
        yield "two paths differ in the names of their parameters only"


def undescribed(document):
    for name, schema in document["components"]["schemas"].items():
        for field, value in schema.get("properties", {}).items():
            if name != "Error" and "description" not in value:
                yield f"{name}.{field}: nothing is said of it"
        for word in schema.get("enum", []):
            if f"- `{word}`: " not in schema["description"]:
                yield f"{name}.{word}: nothing is said of it"


def closed(document):
    """The same, where a field that no schema has is wrong in answers, too."""
    document = copy.deepcopy(document)
    for _, node in everything_in(document):
        if isinstance(node, dict) and isinstance(node.get("properties"), dict) and "type" in node:
            node["additionalProperties"] = node.get("additionalProperties", False)
    return document


def check(value, schema, document, but=()):
    """What is wrong with the value, but for those rules: what is drawn lacks things that the services require."""
    validator = jsonschema.Draft4Validator(schema, resolver=jsonschema.RefResolver("", document))
    return [f"{list(error.absolute_path)}: {error.message[:300]}" for error in validator.iter_errors(value)
            if error.validator not in but]


def content_of(what, kind):
    assert list(what["content"]) == [kind], what
    return what["content"][kind]["schema"]


def wrong_samples(document, samples):
    document = closed(document)
    operations = {op["operationId"]: (path, method, op) for path, method, op in operations_of(document)}
    seen = set(BY_HAND)
    for sample in samples:
        if "error" in sample:
            yield from check(sample["error"], {"$ref": "#/components/schemas/Error"}, document)
            continue
        name = sample["operation"]
        seen.add(name)
        path, method, operation = operations[name]
        target, _, query = sample["target"].partition("?")
        shape = re.sub(r"\\{[^}]*\\}", "[^/]+", re.escape(path))
        if method.upper() != sample["method"] or not re.fullmatch(shape, target):
            yield f"{name}: {sample['method']} {target} is not {method} {path}"
        allowed = {p["name"] for p in operation.get("parameters", []) if p["in"] == "query"}
        for key, _ in urllib.parse.parse_qsl(query, keep_blank_values=True):
            camel = ".".join(re.sub(r"_([a-z])", lambda m: m[1].upper(), part) for part in key.split("."))
            if camel not in allowed:
                yield f"{name}: has no parameter {key}"
        if "body" in sample:
            schema = content_of(operation["requestBody"], "application/json")
            yield from (f"{name}: {trouble}" for trouble in check(sample["body"], schema, document, {"required"}))
        kind = "text/event-stream" if sample["streams"] else "application/json"
        for trouble in check(sample["answer"], content_of(operation["responses"]["200"], kind), document):
            yield f"{name}: {trouble}"
    for name in seen ^ set(operations):
        yield f"{name} is in the document only, or not there"


def main():
    document = json.loads(output_of(sys.argv[1]), object_pairs_hook=without_repeats)
    samples = [json.loads(line) for line in output_of(sys.argv[2]).splitlines()]
    troubles = [trouble for look in (wrong_form, wrong_references, wrong_operations, undescribed)
                for trouble in look(document)]
    troubles += wrong_samples(document, samples)
    print("\n".join(troubles) or f"{len(document['paths'])} paths, {len(samples)} samples, nothing is wrong")
    sys.exit(1 if troubles or not samples else 0)


if __name__ == "__main__":
    main()
