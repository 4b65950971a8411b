#!/usr/bin/env bash
# What the compiler made of the solver's sweeps and of recycling: for each loop over rows in each entry point, how many
# instructions it has, how many calls, and how much of its arithmetic is as wide as the lane. docs/hot-loops.md says how to read it.
#
#   tools/asm.sh [2d|3d]             the table of a dimension, 3d if not told
#   tools/asm.sh 3d F32x8            the assembly of all functions of the kernel with that in their names
#
# Builds into a folder of its own, as check.sh does; CARGO_TARGET_DIR overrides it. Needs objdump.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

dimension="${1:-3d}"
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/avian-kernel-ci/target}"
# With this mangling names say which job an entry point runs.
export RUSTFLAGS="${RUSTFLAGS:-} -Csymbol-mangling-version=v0"
cargo build --quiet --release --lib --package "avian_kernel$dimension"
library="$CARGO_TARGET_DIR/release/libavian_kernel$dimension.rlib"

assembly() {
    # The archive also holds what is not an object, of which objdump complains.
    objdump --disassemble --demangle --no-show-raw-insn "$library" 2>/dev/null || true
}

if [ -n "${2:-}" ]; then
    assembly | awk -v wanted="$2" '/^[0-9a-f]+ <.*>:$/ { on = index($0, wanted) } on'
    exit
fi

# A loop is what lies between a jump back and where it goes. Of loops in each other the inner one counts; one without
# arithmetic is no loop over rows.
assembly | awk '
    function finish(    i, j, k, inner, hot, rows, calls, full, part, scalar, all, loops, width) {
        if (name == "") return
        for (i = 1; i <= count; i++) {
            if (!(i in target) || !(target[i] in at) || at[target[i]] > i) continue
            hot = 0
            for (j = at[target[i]]; j <= i; j++) hot += (kind[j] != "" && kind[j] != "call")
            if (hot >= 20) from[i] = at[target[i]]
        }
        for (i = 1; i <= count; i++) {
            if (!(i in from)) continue
            inner = 1
            for (j = from[i]; j < i; j++) if (j in from && from[j] >= from[i]) inner = 0
            # Several jumps back to one place are one loop: the last of them ends it.
            for (j = i + 1; j <= count; j++) if (j in from && from[j] == from[i]) inner = 0
            if (!inner) continue
            rows = calls = full = part = scalar = 0
            for (j = from[i]; j <= i; j++) {
                rows++
                calls += kind[j] == "call"; full += kind[j] == "ymm"; part += kind[j] == "xmm"; scalar += kind[j] == "ss"
            }
            if (name ~ /x4/) { full = part; part = 0 }
            n[name]++; sum[name] += rows; c[name] += calls; f[name] += full; p[name] += part; s[name] += scalar
        }
        functions[name]++
    }
    function clear() { split("", target); split("", at); split("", kind); split("", from); count = 0 }
    BEGIN { printf "%-12s %9s %5s %12s %6s %11s %9s %7s\n", "entry point", "functions", "loops", "instructions", "calls", "full width", "narrower", "scalar" }
    /^[0-9a-f]+ <.*>:$/ {
        finish(); clear(); name = ""
        if (match($0, /(f32|F32x4|F32x8) as [a-z0-9_]*::math::entry::Entry>::enter(::avx2)?::<[a-z0-9_]*::solver::(contact_batch|joint::joint_batch)::RunJob</)) {
            kind_of_row = /joint::joint_batch/ ? "::joints" : "::sweep"
            name = substr($0, RSTART); sub(/ as .*$/, kind_of_row, name)
        }
        if (/::recycle::RecycleBatch>?::evaluate_at::avx2(::<.*>)?>:$/) name = "F32x8::recycle"
        if (/::recycle::RecycleBatch>?::evaluate_at::baseline(::<.*>)?>:$/) name = "F32x4::recycle"
        next
    }
    name != "" && /^ +[0-9a-f]+:\t/ {
        count++
        address = $1; sub(/:$/, "", address); at[address] = count
        if ($2 ~ /^j/) target[count] = $3
        else if ($2 ~ /^call/) kind[count] = "call"
        else if ($2 ~ /^v?(add|sub|mul|div|sqrt|max|min)ps$/) kind[count] = /%ymm/ ? "ymm" : "xmm"
        else if ($2 ~ /^v?(add|sub|mul|div|sqrt|max|min)ss$/) kind[count] = "ss"
    }
    END {
        finish()
        for (name in n) {
            printf "%-12s %9d %5d %12d %6d %11d %9d %7d\n", name, functions[name], n[name], sum[name], c[name], f[name], p[name], s[name]
        }
    }
'
