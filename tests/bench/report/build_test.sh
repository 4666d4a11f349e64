#!/usr/bin/env bash
# build_test.sh SOURCES WORK: builds the report's template anew in WORK and compares it with the committed one, to the byte.
# Exit 77 where npm is missing or can't reach its packages.
set -euo pipefail
sources=$1 work=$2

command -v npm > /dev/null || { echo "npm is not installed"; exit 77; }
mkdir -p "$work"
cp "$sources"/{package.json,package-lock.json,build.mjs,tsconfig.json} "$work/"
rm -rf "$work/src"
cp -r "$sources/src" "$work/src"
cd "$work"

# The packages stay between runs while the lock file is the same.
if ! cmp -s package-lock.json node_modules/installed-lock.json; then
    if ! npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 > npm.log 2>&1; then
        cat npm.log
        grep -qE 'ENOTFOUND|ECONNREFUSED|ECONNRESET|ETIMEDOUT|EAI_AGAIN|ENETUNREACH|E403' npm.log && { echo "npm can't reach its packages"; exit 77; }
        exit 1
    fi
    cp package-lock.json node_modules/installed-lock.json
fi
npm run --silent check
node build.mjs "$work/template.html"
cmp "$work/template.html" "$sources/template.html" || { echo "bench/report/template.html is not what its sources make: run npm ci && npm run build there."; exit 1; }
