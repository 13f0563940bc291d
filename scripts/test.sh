#!/usr/bin/env bash
# Builds and runs every test through CTest; arguments go to ctest, e.g. scripts/test.sh -R cli -V
#   TESSERA_PRESET=asan|tsan|dev|clang scripts/test.sh    another preset (default: release)
#   scripts/test.sh --all                                 release, asan, tsan and clang builds, then clang-tidy
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD

if [[ ${1:-} == --all ]]; then
    shift
    scripts/setup all
    for preset in release asan tsan clang; do
        echo "== $preset"
        TESSERA_PRESET=$preset scripts/test.sh "$@"
    done
    echo "== tidy"
    exec scripts/tidy
fi

preset=${TESSERA_PRESET:-release}
folder=build/$preset
if [[ $preset == clang ]]; then scripts/setup all; else scripts/setup test; fi

seconds_since() {
    local tenths=$(((${EPOCHREALTIME/[.,]/} - $1) / 100000))
    echo "$((tenths / 10)).$((tenths % 10))"
}

start=${EPOCHREALTIME/[.,]/}
scripts/build "$preset"
build_seconds=$(seconds_since "$start")

suppressions=$root/tests/support
export ASAN_OPTIONS="${ASAN_OPTIONS:-detect_stack_use_after_return=1:allocator_may_return_null=1}"
export LSAN_OPTIONS="${LSAN_OPTIONS:-suppressions='$suppressions/lsan.supp':print_suppressions=0}"
export TSAN_OPTIONS="${TSAN_OPTIONS:-suppressions='$suppressions/tsan.supp':ignore_noninstrumented_modules=1:print_suppressions=0}"
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"

# ThreadSanitizer of GCC 12 cannot map its shadow where newer kernels randomise addresses more widely.
runner=(ctest)
if [[ $preset == tsan ]] && setarch -R true 2>/dev/null; then runner=(setarch -R ctest); fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
"${runner[@]}" --test-dir "$folder" --output-on-failure --no-tests=error -j"$(nproc)" "$@" 2>&1 | tee "$log" || status=$?

unit_seconds=$(awk '$1 ~ /^[0-9]+\/[0-9]+$/ && $4 ~ /^unit/ { total += $(NF - 1) } END { printf "%.1f", total }' "$log")
echo
echo "build ($preset): $build_seconds s; unit tests: $unit_seconds s"
grep -E '^[0-9]+% tests passed' "$log" || true
exit "$status"
