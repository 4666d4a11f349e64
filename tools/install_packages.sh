#!/usr/bin/env bash
# Installs the Debian packages of packages.txt that are missing, when allowed to; else prints the command and exits 4.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

missing=()
while read -r package; do
    [[ -z $package || $package == \#* ]] && continue
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [[ $state == installed ]] || missing+=("$package")
done < packages.txt
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
