"""Checks the OpenAPI document that a program prints: against the OpenAPI Initiative's schema, for rules beyond that
schema, and against samples of requests and answers. Usage: check_openapi.py DOCUMENT_PROGRAM SAMPLES_PROGRAM"""
import copy
import json
import re
import subprocess
import sys
import urllib.parse

import jsonschema

SCHEMA = "/usr/share/openapi-specification/schemas/v3.0/schema.json"
METHODS = {"get", "put", "post", "delete", "patch", "head"}
OPEN = {"GetHealth", "GetMetrics", "GetOpenApi", "SignIn"}  # operations without sign-in
# Rules that the services check, so random requests may break them.
RULES = {"required", "minimum", "maximum", "maxLength", "minItems", "maxItems", "maxProperties"}
BY_HAND = {"GetHealth", "GetMetrics", "GetOpenApi", "DownloadArtifact", "HeadArtifact", "HeadUpload", "PatchUpload"}


def output_of(program):
    return subprocess.run([program], check=True, stdout=subprocess.PIPE).stdout.decode()


def without_repeats(pairs):
    names = [name for name, _ in pairs]
    assert len(names) == len(set(names)), f"a name occurs twice in {names}"
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
    used |= {f"#/components/securitySchemes/{name}" for _, _, operation in operations_of(document)
             for needed in operation["security"] for name in needed}
    for place, node in everything_in(document):
        if not isinstance(node, dict):
            continue
        if isinstance(node.get("$ref"), str):
            used.add(node["$ref"])
            if len(node) > 1:
                yield f"{place}: keywords next to $ref are ignored"
        for name in node.get("required", []) if "properties" in node else []:
            if name not in node["properties"]:
                yield f"{place}: requires {name}, but has no such property"
    for name in used ^ known:
        yield f"{name} is undefined or unused"


def wrong_operations(document):
    names = [operation["operationId"] for _, _, operation in operations_of(document)]
    if len(names) != len(set(names)):
        yield f"two operations have the same name: {sorted(names)}"
    for path, method, operation in operations_of(document):
        if method not in METHODS:
            yield f"{path}: {method} is not an HTTP method"
        parameters = [(p["in"], p["name"]) for p in operation.get("parameters", [])]
        if len(parameters) != len(set(parameters)):
            yield f"{method} {path}: a parameter occurs twice"
        declared = {name for place, name in parameters if place == "path"}
        if declared != set(re.findall(r"{([^}]*)}", path)):
            yield f"{method} {path}: declares {declared}"
        if not operation.get("summary"):
            yield f"{method} {path}: has no summary"
    shapes = [re.sub(r"{[^}]*}", "{}", path) for path in document["paths"]]
    if len(shapes) != len(set(shapes)):
        yield "two paths differ only in the names of their parameters"


def wrong_security(document):
    schemes = document["components"]["securitySchemes"]
    for path, method, operation in operations_of(document):
        name, needed = operation["operationId"], operation["security"]
        if (needed == []) != (name in OPEN):
            yield f"{name}: needs {needed}"
        for one in needed:
            by_cookie = any(schemes[scheme].get("in") == "cookie" for scheme in one)
            by_header = any(schemes[scheme].get("in") == "header" for scheme in one)
            if by_header != (by_cookie and method not in {"get", "head"}):
                yield f"{name}: a cookie needs the CSRF header exactly for changes: {one}"
        if needed and not any(schemes[scheme].get("scheme") == "bearer" for one in needed for scheme in one):
            yield f"{name}: an API key is not accepted"


def undescribed(document):
    for name, schema in document["components"]["schemas"].items():
        for field, value in schema.get("properties", {}).items():
            if name != "Error" and "description" not in value:
                yield f"{name}.{field}: has no description"
        for word in schema.get("enum", []):
            if f"- `{word}`: " not in schema["description"]:
                yield f"{name}.{word}: has no description"


def wrong_rules(document):
    """Checks examples of all forms of field rules (proto/hydroprint/v1/field_rules.proto)."""
    schemas = document["components"]["schemas"]
    expected = {
        ("SimulateSpecInput", "dpi"): {"minimum": 20, "maximum": 2400, "default": 300, "example": 600,
                                       "x-unit": "dots per inch"},
        ("PredictSpecInput", "dpi"): {"minimum": 20, "maximum": 2400},
        ("PrintImageSpecInput", "jobName"): {"maxLength": 200, "x-max-bytes": 200},
        ("SimulateSpecInput", "film"): {"maxLength": 300, "default": "A4", "format": "film"},
        ("SimulateSpecInput", "model"): {"default": "MODEL_SHEET"},
        ("SimulateSpecInput", "extraFiles"): {"maxItems": 256},
        ("PoseInput", "rotationWxyz"): {"minItems": 4, "maxItems": 4, "example": [1, 0, 0, 0]},
        ("PrintImageSpecInput", "inkLimit"): {"minimum": 0, "exclusiveMinimum": True, "maximum": 4},
        ("PrintImageSpecInput", "formats"): {"items": {"type": "string", "enum": ["pdf", "png", "tiff"]}},
        ("JobInput", "labels"): {"maxProperties": 32,
                                 "additionalProperties": {"type": "string", "maxLength": 200, "x-max-bytes": 200}},
        ("JobInput", "state"): {"readOnly": True},
        ("Job", "state"): {"readOnly": True},
        ("MoveToRequest", "positionMm"): {"x-unit": "mm"},
        ("AcquireLeaseRequest", "ttl"): {"default": "600s"},
    }
    for (name, field), keywords in expected.items():
        found = schemas[name]["properties"][field]
        for keyword, value in keywords.items():
            if found.get(keyword) != value:
                yield f"{name}.{field}: {keyword} is {found.get(keyword)}, not {value}"
    for name, field in [("PredictSpecInput", "mesh"), ("MoveToRequest", "positionMm"), ("AcquireLeaseRequest", "purpose")]:
        if field not in schemas[name].get("required", []):
            yield f"{name} does not require {field}"
    if "default" in schemas["SimulateSpecInput"]["properties"]["depthMm"]:
        yield "SimulateSpecInput.depthMm: a word is not a valid default for a number"
    if "minimum" in schemas["SimulateSpec"]["properties"]["dpi"]:
        yield "SimulateSpec.dpi: answers may be older than the rules"


def wrong_values(document):
    """Yields the defaults and examples that violate their own schemas."""
    for name, schema in document["components"]["schemas"].items():
        for field, value in schema.get("properties", {}).items():
            for keyword in ("default", "example"):
                if keyword in value:
                    for trouble in check(value[keyword], value, document):
                        yield f"{name}.{field}: its {keyword}: {trouble}"


def closed(document):
    """Returns a copy of the document in which unknown fields are errors, in answers too."""
    document = copy.deepcopy(document)
    for _, node in everything_in(document):
        if isinstance(node, dict) and isinstance(node.get("properties"), dict) and "type" in node:
            node["additionalProperties"] = node.get("additionalProperties", False)
    return document


def check(value, schema, document, but=()):
    """Returns the violations in a value. `but`: rules to ignore, because random values lack required fields."""
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
            yield from (f"{name}: {trouble}" for trouble in check(sample["body"], schema, document, RULES))
        if "media_type" in sample:  # the answer is not JSON
            schema = content_of(operation["responses"]["200"], sample["media_type"])
            if schema != {"type": "string", "format": "binary"}:
                yield f"{name}: its bytes are described as {schema}"
            continue
        kind = "text/event-stream" if sample["streams"] else "application/json"
        for trouble in check(sample["answer"], content_of(operation["responses"]["200"], kind), document):
            yield f"{name}: {trouble}"
    for name in seen ^ set(operations):
        yield f"{name} is only in the document, or missing there"


def main():
    document = json.loads(output_of(sys.argv[1]), object_pairs_hook=without_repeats)
    samples = [json.loads(line) for line in output_of(sys.argv[2]).splitlines()]
    troubles = [trouble for look in (wrong_form, wrong_references, wrong_operations, wrong_security, undescribed,
                                                   wrong_rules, wrong_values)
                for trouble in look(document)]
    troubles += wrong_samples(document, samples)
    print("\n".join(troubles) or f"{len(document['paths'])} paths, {len(samples)} samples, no violations")
    sys.exit(1 if troubles or not samples else 0)


if __name__ == "__main__":
    main()
