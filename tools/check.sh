#!/usr/bin/env bash
# Everything a change has to pass, from the quickest to the slowest. No arguments; fails at the first failure.
#
# Builds go to a folder of their own, outside of the tree, so that they neither wait for an editor's builds nor
# throw them away; CARGO_TARGET_DIR overrides it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/avian-kernel-ci/target}"
# Incremental files are of no use to a build that runs once, and many times the size of the result.
export CARGO_INCREMENTAL=0

SECONDS=0
stage() {
    echo "== ${SECONDS} s: $*"
    "$@"
}

# Cargo knows the crates of another clone of this tree by the same names, and looks for changes where that one
# was: with sources outside of a package's folder it would test the other clone. Only dependencies are kept.
# A call cleans one profile only.
for manifest in Cargo.toml crates/far_f64/Cargo.toml; do
    for profile in dev release; do
        stage cargo clean --quiet --workspace --profile "$profile" --manifest-path "$manifest"
    done
done

stage cargo fmt --all --check

# The kernel builds in seconds: what is wrong in it is known before Bevy is compiled. Its precisions and
# dimensions are features, so each package is tested alone.
for dimension in 2d 3d; do
    stage cargo test --quiet --package "avian_kernel$dimension"
    stage cargo test --quiet --package "avian_kernel$dimension" --features f64
done

# The bits are the same without optimisation, and with all of it.
for dimension in 2d 3d; do
    plain="profile.dev.package.avian_kernel$dimension.opt-level=0"
    stage cargo test --quiet --package "avian_kernel$dimension" --config "$plain" --test it golden_hashes
    stage cargo test --quiet --package "avian_kernel$dimension" --release --test it golden
done

# The libraries with the features of the README's command, so that Bevy is compiled once for lints and once
# for tests. What draws is linted and tested without a window: no renderer is built here.
stage cargo clippy --workspace --exclude examples2d --exclude examples3d --exclude testbed --all-targets -- -D warnings
stage cargo clippy --package testbed --no-default-features -- -D warnings
stage cargo test --quiet --package testbed --no-default-features
stage cargo test --quiet

# World positions in f64 exclude f32 in one build, so their tests, and the engine's unit tests in f64, are a workspace
# of their own.
stage cargo test --quiet --manifest-path crates/far_f64/Cargo.toml

# `parallel` changes nothing here but Bevy's features: with it, what clippy compiled of Bevy serves again.
for dimension in 2d 3d; do
    stage cargo check --package "avian$dimension" --no-default-features --features "$dimension,f64,parry-f64,parallel"
done

# Without the default collider, as crates ask for that bring none.
stage cargo check --package avian3d --no-default-features --features 3d,f32,parallel

RUSTDOCFLAGS="-D warnings" stage cargo doc --no-deps \
    --package avian2d --package avian3d --package avian_kernel2d --package avian_kernel3d

echo "== all passed in $((SECONDS / 60)) min $((SECONDS % 60)) s"
