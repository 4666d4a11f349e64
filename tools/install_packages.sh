#!/usr/bin/env bash
# Installs the Debian packages that are missing of the given lists, when allowed to; else prints the command and exits 4.
# tools/install_packages.sh [LIST...] [default: packages.txt]. A line: PACKAGE [COMMAND]; with a command, the package is missing only where
# the command is: it may have come from elsewhere.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

lists=("$@")
[[ ${#lists[@]} -eq 0 ]] && lists=(packages.txt)
missing=()
while read -r package command; do
    [[ -z $package || $package == \#* ]] && continue
    [[ -n $command ]] && command -v "$command" > /dev/null && continue
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
done < <(cat "${lists[@]}")
[[ ${#missing[@]} -eq 0 ]] && exit 0

echo "Missing packages: ${missing[*]}" >&2
if [[ $(id -u) -eq 0 ]]; then
    elevate=()
elif command -v sudo > /dev/null && sudo -n true 2> /dev/null; then
    elevate=(sudo -n)
else
    echo "Install them with: sudo apt-get update && sudo apt-get install -y --no-install-recommends ${missing[*]}" >&2
    exit 4
fi
"${elevate[@]}" apt-get update -qq >&2
"${elevate[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
