#!/usr/bin/env bash
# Writes the generated pages anew: docs/reference/scene-reference.md from the schema, the functions of docs/reference/formula-language.md. It
# needs the tests' programs (./test.sh or cmake --build --preset release).
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
cmake --build "$root/build/release" --target unit_tests
"$root/build/release/tests/unit_tests" "[.write-pages]"
