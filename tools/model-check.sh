#!/usr/bin/env bash
# What CI does not look at: whether threads can meet in a way that tests do not. Takes some minutes, most of them to compile.
#
#   tools/model-check.sh loom     the thread pool in every interleaving up to a few preemptions (kernel/thread_pool/model.rs)
#   tools/model-check.sh threads  the tests of the thread pool and of shared solving under ThreadSanitizer; needs a toolchain with
#                                 the standard library's source, named by SANITIZER_TOOLCHAIN (nightly if not told)
#   tools/model-check.sh          loom, and threads where that toolchain is to be had
#
# Builds into folders of its own below CARGO_TARGET_DIR, since all flags differ.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

target="${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/avian-kernel-ci/target}"
toolchain="${SANITIZER_TOOLCHAIN:-nightly}"
host="$(rustc -vV | sed -n 's/^host: //p')"

loom() {
    RUSTFLAGS="--cfg loom" CARGO_TARGET_DIR="$target/loom" \
        cargo test --package avian_kernel3d --lib thread_pool::model -- --test-threads 1
}

has_source() {
    local root
    root="$(rustc "+$toolchain" --print sysroot 2>/dev/null)" && [ -d "$root/lib/rustlib/src/rust/library" ]
}

threads() {
    for dimension in 2d 3d; do
        # The standard library is compiled with the sanitizer too: else what its locks order would be told as races.
        RUSTFLAGS="-Zsanitizer=thread" CARGO_TARGET_DIR="$target/sanitizer" \
            cargo "+$toolchain" test -Zbuild-std --target "$host" --package "avian_kernel$dimension" --lib thread_pool::tests
        RUSTFLAGS="-Zsanitizer=thread" CARGO_TARGET_DIR="$target/sanitizer" \
            cargo "+$toolchain" test -Zbuild-std --target "$host" --package "avian_kernel$dimension" --test it sound
    done
}

case "${1:-all}" in
    loom) loom ;;
    threads) threads ;;
    all)
        loom
        if has_source; then
            threads
        else
            echo "no sources of the standard library for $toolchain: ThreadSanitizer left out"
        fi
        ;;
    *)
        echo "loom, threads, or nothing" >&2
        exit 1
        ;;
esac
