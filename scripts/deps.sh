#!/bin/sh
# Installs what scripts/packages.txt names and this machine lacks. Touches nothing, and needs
# neither network nor root, when all of it is there.
#   deps.sh         what building and running need
#   deps.sh test    and what the tests need
#   deps.sh lint    and what the static checks need
#   deps.sh docs    and what the gallery's pictures need
set -eu
cd "$(dirname "$0")/.."

kinds=build${1:+|$1}
wanted=$(awk -v kinds="^($kinds)\$" '!/^#/ && $2 ~ kinds { print $1 }' scripts/packages.txt)

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "deps: this is not a Debian system; install what these packages hold yourself:" >&2
    echo "$wanted" | sed 's/^/    /' >&2
    exit 0
fi

# shellcheck disable=SC2086  # one word a package
installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' $wanted 2>/dev/null |
    awk '$2 == "installed" { print $1 }')
missing=$(printf '%s\n' "$wanted" | grep -vxF "${installed:-none}" || true)
[ -n "$missing" ] || exit 0

echo "deps: to be installed:" $missing
if [ "$(id -u)" -eq 0 ]; then
    as_root=
elif command -v sudo >/dev/null 2>&1; then
    as_root=sudo
else
    echo "deps: these packages are missing, and only root may install them. As root, run:" >&2
    echo "    apt-get update && apt-get install --no-install-recommends" $missing >&2
    exit 1
fi
# shellcheck disable=SC2086
{
    $as_root apt-get update -q
    $as_root env DEBIAN_FRONTEND=noninteractive \
        apt-get install -q -y --no-install-recommends $missing
} || {
    echo "deps: apt could not install the packages above; its own message says why." >&2
    exit 1
}
