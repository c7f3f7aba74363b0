#!/bin/bash
# Writes the reference of the public headers: docs/doxygen.sh FOLDER. Fails where Doxygen has a warning: something public without a
# word, or a word about something that is not there.
set -eu
folder=$(mkdir -p "$1" && readlink -f -- "$1")
cd "$(dirname "$0")/.."
(cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = $folder") | doxygen -
