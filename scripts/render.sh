#!/usr/bin/env bash
# Renders a scene from a bare checkout: installs what is missing, builds, runs 'tessera render'.
#   scripts/render.sh                        scenes/whitted/whitted.toml -> out/whitted.exr and .png
#   scripts/render.sh my.obj -o my.exr ...   arguments go to 'tessera render'; paths are relative to where you are
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)

"$root/scripts/setup" render
"$root/scripts/build" release tessera

tessera=$root/build/release/bin/tessera
if (($#)); then
    exec "$tessera" render "$@"
fi
cd "$root"
mkdir -p out
exec "$tessera" render scenes/whitted/whitted.toml -o out/whitted.exr --preview out/whitted.png
