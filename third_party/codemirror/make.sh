#!/bin/sh
# Makes codemirror.module.js from entry.js, anew or of other versions. Only for who changes it: wants npm and the network.
set -e
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$here/entry.js" .
npm install --no-audit --no-fund @codemirror/view@6.43.15 @codemirror/state@6.7.6 @codemirror/commands@6.11.1 @codemirror/language@6.13.1 \
  @codemirror/lint@6.9.8 @codemirror/autocomplete@6.20.4 @lezer/highlight@1.2.5 esbuild@0.28.2
node node_modules/esbuild/install.js
node_modules/.bin/esbuild entry.js --bundle --format=esm --minify --legal-comments=none --target=es2021 --outfile="$here/codemirror.module.js"
