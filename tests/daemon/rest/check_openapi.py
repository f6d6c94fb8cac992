"""Checks the OpenAPI document that a program prints: against the OpenAPI Initiative's own schema, and for what that
schema cannot say. Usage: check_openapi.py PROGRAM"""
import json
import re
import subprocess
import sys

import jsonschema

SCHEMA = "/usr/share/openapi-specification/schemas/v3.0/schema.json"
METHODS = {"get", "put", "post", "delete", "patch", "head"}


def pairs_without_repeats(pairs):
    names = [name for name, _ in pairs]
    assert len(names) == len(set(names)), f"a name is there twice among {names}"
    return dict(pairs)


def everything_in(node, place=""):
    yield place, node
    items = node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else []
    for key, value in items:
        yield from everything_in(value, f"{place}/{key}")


def troubles_of(document):
    with open(SCHEMA) as file:
        schema = json.load(file)
    for error in jsonschema.Draft4Validator(schema).iter_errors(document):
        yield f"{list(error.absolute_path)}: {error.message[:500]}"
    names = set()
    for place, node in everything_in(document):
        if isinstance(node, dict) and isinstance(node.get("$ref"), str):
            if node["$ref"] not in all_references(document):
                yield f"{place}: {node['$ref']} leads nowhere"
            if len(node) > 1:
                yield f"{place}: what stands beside $ref counts for nothing"
        if isinstance(node, dict) and isinstance(node.get("required"), list) and "properties" in node:
            for name in node["required"]:
                if name not in node["properties"]:
                    yield f"{place}: requires {name}, which it does not have"
    for path, item in document["paths"].items():
        for method, operation in item.items():
            if method not in METHODS:
                yield f"{path}: {method} is no HTTP method"
            if operation["operationId"] in names:
                yield f"{path}: {operation['operationId']} is the name of another operation, too"
            names.add(operation["operationId"])
            parameters = [(p["in"], p["name"]) for p in operation.get("parameters", [])]
            if len(parameters) != len(set(parameters)):
                yield f"{method} {path}: a parameter is there twice"
            declared = {name for place, name in parameters if place == "path"}
            if declared != set(re.findall(r"{([^}]*)}", path)):
                yield f"{method} {path}: declares {declared}"
    shapes = [re.sub(r"{[^}]*}", "{}", path) for path in document["paths"]]
    if len(shapes) != len(set(shapes)):
        yield "two paths differ in the names of their parameters only"


def all_references(document):
    return {f"#/components/{kind}/{name}" for kind, named in document["components"].items() for name in named}


def main():
    text = subprocess.run([sys.argv[1]], check=True, stdout=subprocess.PIPE).stdout
    document = json.loads(text, object_pairs_hook=pairs_without_repeats)
    troubles = list(troubles_of(document))
    print("\n".join(troubles) or f"{len(document['paths'])} paths, nothing is wrong")
    sys.exit(1 if troubles else 0)


main()
