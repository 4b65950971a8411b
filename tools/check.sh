#!/usr/bin/env bash
set -euo pipefail

usage() {
    cat <<'EOF'
Everything a change has to pass. Goes on after a failure, and prints all
of them again at the end.

    tools/check.sh            what CI runs: a third of an hour on a fast machine with two cores, three times that on a slow one
    tools/check.sh --full     the same, then golden hashes of the kernel in release and without any optimisation, characters at all
                              rates, and more random changes: before a release, and after a change of compiler
    tools/check.sh --fast     formatting, rules of the source tree, lints and tests of the kernel in f32, golden hashes
                              among them, but for the longest: no Bevy, three minutes
    tools/check.sh --hunt [N] the kernel's tests N times (10 if not told) with other random input each time
    tools/check.sh --help     this

Needs Rust with rustfmt and clippy, and a C compiler to link with.

The same tree gets the same verdict: property tests draw their input from a fixed seed, PROPTEST_RNG_SEED, here 1
if it is not set. `--hunt` prints the seed of each round; the round that fails is repeated by

    PROPTEST_RNG_SEED=<seed> cargo test --package avian_kernel3d

Plain `cargo test` takes a new seed each time.

What is checked is a copy of the tree in the folder `check` of CARGO_TARGET_DIR, or of avian-kernel-ci/target in the
user's cache: only what changed since the last check is compiled again, whichever clone that was of.
EOF
}

mode=all
rounds=10
case "${1:-}" in
    "") ;;
    --fast | --full | --hunt) mode="${1#--}" ;;
    --help | -h)
        usage
        exit
        ;;
    *)
        echo "unknown argument: $1" >&2
        usage >&2
        exit 2
        ;;
esac
if [ "$mode" = hunt ] && [ $# -gt 1 ]; then
    rounds="$2"
    shift
fi
if [ $# -gt 1 ] || ! [[ "$rounds" =~ ^[1-9][0-9]*$ ]]; then
    echo "unknown arguments" >&2
    usage >&2
    exit 2
fi

source="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
target="${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/avian-kernel-ci/target}/check"
mkdir -p "$target"
export CARGO_TARGET_DIR="$(cd "$target" && pwd)"
copy="$CARGO_TARGET_DIR/tree"
# Incremental files are many times the size of the result, and save little where a whole crate is compiled.
export CARGO_INCREMENTAL=0
# What is inlined is compiled once in each unit of code: 4 instead of 16 take a quarter less.
export CARGO_PROFILE_DEV_CODEGEN_UNITS=4
export PROPTEST_RNG_SEED="${PROPTEST_RNG_SEED:-1}"
# Messages tell what failed.
export RUST_BACKTRACE=0

SECONDS=0
TIMEFORMAT='   %R s, %U s of processors'
failed=()
log="$CARGO_TARGET_DIR/check.log"
stage() {
    echo "== $((SECONDS / 60)) min $((SECONDS % 60)) s: $*"
    time "$@" 2>&1 | tee -a "$log" || failed+=("$*")
}

# The files of a folder, but for what is built and what is git's.
files() {
    (cd "$1" && find . \( -name target -o -name .git -o -path ./out \) -prune -o \( -type f -o -type l \) -print0)
}

# Makes the copy equal to the tree, and touches nothing that is equal already: cargo goes by the times of files.
# Building each clone where it is would not do. Cargo takes the crates of two clones for the same, and as their
# sources lie outside of their packages it would look for changes in the clone that was built last. For the same
# reason nothing but this script builds into this folder.
synchronise() {
    local file
    mkdir -p "$copy"
    while IFS= read -r -d '' file; do
        [ -f "$source/$file" ] || rm "$copy/$file"
    done < <(files "$copy")
    find "$copy" -depth -type d -empty -delete
    mkdir -p "$copy"
    while IFS= read -r -d '' file; do
        cmp -s "$source/$file" "$copy/$file" && continue
        mkdir -p "$copy/${file%/*}"
        cp "$source/$file" "$copy/$file"
    done < <(files "$source")
}

# Formatting first: it takes a second.
formatting() {
    stage cargo fmt --all --check
    stage cargo fmt --manifest-path crates/far_f64/Cargo.toml --all --check
}

# What no compiler checks: which way imports point, where a dimension may be named, README against the example. And
# that Cargo.lock fits the manifests: the first command would mend it in the copy otherwise.
rules() {
    stage cargo test --quiet --locked --package rules
}

# The bits of whole scenes with all optimisation. Tests of the kernel have them with less.
golden_hashes() {
    for dimension in 2d 3d; do
        stage cargo test --quiet --package "avian_kernel$dimension" --release --test it golden
    done
}

# The same without any, last: the scenes take a quarter of an hour then on slow machines.
plain_golden_hashes() {
    for dimension in 2d 3d; do
        local plain="profile.dev.package.avian_kernel$dimension.opt-level=0"
        stage cargo test --quiet --package "avian_kernel$dimension" --config "$plain" --test it golden_hashes
    done
}

# The tests of the kernel alone. Dimensions and precisions are features, so each package is built by itself.
kernel_tests() {
    for dimension in 2d 3d; do
        stage cargo test --quiet --no-fail-fast --package "avian_kernel$dimension" "$@"
    done
}

# The kernel's lints where no Bevy is compiled.
kernel_lints() {
    for dimension in 2d 3d; do
        stage cargo clippy --quiet --package "avian_kernel$dimension" --all-targets -- -D warnings
    done
}

# All lints, of libraries, tests and benches. What draws is left out: its renderer needs system libraries, and the
# testbed without its window is the package testbed_headless. Features are those of the tests below.
lints() {
    stage cargo clippy --quiet --workspace --exclude examples2d --exclude examples3d --exclude testbed \
        --all-targets -- -D warnings
}

# What the README tells newcomers to run, to the letter. The kernel's tests in f32 are among these.
readme_tests() {
    stage cargo test --quiet
}

# Characters at all rates, and more random changes.
long_tests() {
    for dimension in 2d 3d; do
        AVIAN_LONG_TESTS=1 stage cargo test --quiet --package "avian$dimension" --test it --test lifecycle
    done
}

# World positions in f64 exclude f32 in one build: their tests, and the engine's unit tests in f64, are a workspace
# of their own. Bevy has the same features there, and is not compiled again.
f64_tests() {
    stage cargo test --quiet --locked --manifest-path crates/far_f64/Cargo.toml
}

# The features of apps that no test has: no default collider, as crates ask for that bring none.
feature_sets() {
    stage cargo check --quiet --package avian3d --package avian_derive --no-default-features --features 3d,f32,parallel
}

# Documentation without a broken link. Cargo looks for changes in the folder of a package only, and the sources are
# outside, so what it made before goes first.
documentation() {
    stage cargo clean --quiet --doc
    RUSTDOCFLAGS="-D warnings" stage cargo doc --quiet --no-deps --package avian_derive \
        --package avian2d --package avian3d --package avian_kernel2d --package avian_kernel3d
}

# Two checks at once would change the copy below each other.
wait_for_others() {
    command -v flock >/dev/null || return 0
    exec 9>"$CARGO_TARGET_DIR/check.lock"
    flock --nonblock 9 && return
    echo "waiting for another check in $CARGO_TARGET_DIR"
    flock 9
}

main() {
    wait_for_others
    : >"$log"
    synchronise
    cd "$copy"
    case "$mode" in
        fast)
            formatting
            rules
            kernel_lints
            # Without the modules of tests/kernel that look at many runs of many seconds.
            kernel_tests -- --skip leaning --skip rest:: --skip tiles --skip ghosts
            ;;
        hunt)
            for round in $(seq "$rounds"); do
                export PROPTEST_RNG_SEED=$((RANDOM << 30 | RANDOM << 15 | RANDOM))
                echo "== round $round: PROPTEST_RNG_SEED=$PROPTEST_RNG_SEED"
                kernel_tests --lib --test it
            done
            ;;
        all | full)
            # What newcomers run comes first: on a slow machine, or in too short a time, it says most.
            formatting
            rules
            readme_tests
            # Unit tests are the same in f64.
            kernel_tests --features f64 --test it
            lints
            documentation
            f64_tests
            feature_sets
            if [ "$mode" = full ]; then
                long_tests
                golden_hashes
                plain_golden_hashes
            fi
            ;;
    esac
    if [ ${#failed[@]} -gt 0 ]; then
        # What failing tests said, without what ran beside them.
        sed -n '/^---- /,/^failures:/{/^failures:/!p}' "$log"
        printf '== failed: %s\n' "${failed[@]}"
        return 1
    fi
    echo "== all passed in $((SECONDS / 60)) min $((SECONDS % 60)) s"
}

# In one line: a change of this file while it runs has no effect.
{ main; exit; }
