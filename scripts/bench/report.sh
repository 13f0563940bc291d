#!/usr/bin/env bash
# The project's standard report: error against run time on scenes that come with it, Whitted's of 1980 first.
#   scripts/bench/report.sh [FOLDER] [OPTION...]    default: out/report; options go to 'tessera converge'
# SECONDS_EACH (default 20) is the time of a run, REFERENCE_SPP (default 4096) what references get; those in FOLDER are used
# again. TESSERA names the program (default: the release build).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

folder=out/report
if (($#)) && [[ $1 != -* ]]; then
    folder=$1
    shift
fi
tessera=${TESSERA:-build/release/bin/tessera}
[[ -x $tessera ]] || { echo "report: there is no $tessera; scripts/build makes it" >&2; exit 1; }

# The same ray tree as in 1980 and the path tracer, both against the path-traced picture.
exec "$tessera" converge \
    whitted=scenes/whitted/whitted.toml whitted=scenes/whitted/whitted_path.toml \
    scenes/cornell/cornell.toml scenes/glass/glass.toml scenes/veach_mis/veach_mis.toml \
    --res 512x512 --time "${SECONDS_EACH:-20}" --reference-spp "${REFERENCE_SPP:-4096}" \
    --reference whitted=scenes/whitted/whitted_path.toml \
    --history 'whitted/1980: 74 min on a VAX-11/780 (Whitted, CACM 23(6), 1980)@4440' \
    -o "$folder" "$@"
