#!/usr/bin/env bash
# page_test.sh WRITER PACKAGES PAGES: tries the pure parts of the page's sources, then in headless Chromium the pages of made-up results that
# WRITER writes to PAGES; with npm's packages in PACKAGES.
# Exit 77 where the browser, Node.js or the packages are missing.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
writer=$1 packages=$(realpath -m "$2") pages=$(realpath -m "$3")

command -v node > /dev/null || { echo "Node.js is not installed"; exit 77; }
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || { echo "Chromium is not installed"; exit 77; }
[[ -d $packages/node_modules/playwright-core ]] || { echo "npm's packages are not there"; exit 77; }
rm -rf "$pages"
"$writer" "$pages"
BROWSER=$browser PACKAGES=$packages PAGES=$pages exec node --test --test-reporter=spec "$here/modules_test.mjs" "$here/page_test.mjs"
