#!/usr/bin/env bash
set -euo pipefail

usage() {
    cat <<'EOT'
The price of a change: instructions a step of the kernel's scenes, and their ratio to a base commit.

    tools/cost.sh [BASE]      this tree against BASE. Without BASE: against HEAD if anything is changed, else HEAD~1
    tools/cost.sh --limit N   the same, and fails if a scene at rest costs more than N percent more than in BASE
    tools/cost.sh --help      this

Instructions are counted by callgrind, with one worker, in release (thin LTO, one codegen unit, as in benches/). The
same two trees give the same counts on the same machine, whatever else runs there. Counts of other machines differ:
another CPU or C library takes other paths.

The scenes are those of this tree (tests/kernel/costs.rs), also for BASE. Everything else is BASE's own: the kernel,
its step (tests/kernel/sim.rs) and the helpers of its tests. BASE has to compile with these scenes.

    *   bodies move otherwise than in BASE: the ratio also holds what the other motion costs

Needs git and valgrind (Debian: apt install valgrind). COST_JOBS is the number of scenes that are counted at once: as
many as there are processors if not told. Builds are in the folder `cost` of CARGO_TARGET_DIR, or of
avian-kernel-ci/target in the user's cache, and are used again where no source of the kernel differs.
EOT
}

fail() {
    echo "$1" >&2
    exit 2
}

base=
limit=
while [ $# -gt 0 ]; do
    case "$1" in
        --help | -h)
            usage
            exit
            ;;
        --limit)
            limit="${2:-}"
            [[ "$limit" =~ ^[0-9]+(\.[0-9]+)?$ ]] || fail "--limit takes a percentage"
            shift
            ;;
        -*) fail "unknown argument: $1, see --help" ;;
        *)
            [ -z "$base" ] || fail "one BASE only, see --help"
            base="$1"
            ;;
    esac
    shift
done
command -v valgrind >/dev/null || fail "valgrind is missing (Debian: apt install valgrind)"

cd "$(dirname "${BASH_SOURCE[0]}")/.."
target="${CARGO_TARGET_DIR:-${XDG_CACHE_HOME:-$HOME/.cache}/avian-kernel-ci/target}/cost"
mkdir -p "$target/bin"
export CARGO_TARGET_DIR="$(cd "$target" && pwd)"
# Both sides are built in this folder, one after the other: equal sources become equal binaries, paths included.
tree="$CARGO_TARGET_DIR/tree"
export CARGO_PROFILE_RELEASE_LTO=thin CARGO_PROFILE_RELEASE_CODEGEN_UNITS=1
dimensions="2d 3d"

# The tree object of what lies in this folder, with changes that are not committed.
tree_here() {
    local GIT_INDEX_FILE="$scratch/index"
    export GIT_INDEX_FILE
    git read-tree HEAD
    git add --all
    git write-tree
}

# Makes the folder that is built equal to a tree object, and touches nothing that is equal already.
check_out() {
    mkdir -p "$tree"
    GIT_INDEX_FILE="$CARGO_TARGET_DIR/tree.index" git --work-tree="$tree" read-tree --reset -u "$1"
}

# Puts the scenes into the folder that is built, and names them where BASE does not.
add_scenes() {
    local file dimension
    for file in tests/kernel/costs.rs crates/avian_kernel{2d,3d}/benches/costs.rs; do
        mkdir -p "$tree/${file%/*}"
        git show "$here:$file" | cmp -s - "$tree/$file" || git show "$here:$file" >"$tree/$file"
    done
    if ! grep -q 'mod costs;' "$tree/tests/kernel/mod.rs"; then
        printf '\n#[allow(unused)]\npub mod costs;\n' >>"$tree/tests/kernel/mod.rs"
    fi
    for dimension in $dimensions; do
        file="$tree/crates/avian_kernel$dimension/Cargo.toml"
        grep -q '"costs"' "$file" || printf '\n[[bench]]\nname = "costs"\nharness = false\n' >>"$file"
    done
}

# A name for the binaries of the folder that is built: equal for equal sources and compilers.
key() {
    (
        cd "$tree"
        rustc -vV
        echo "${RUSTFLAGS:-}"
        find Cargo.toml Cargo.lock kernel tests/kernel crates/avian_kernel{2d,3d} -type f | LC_ALL=C sort |
            while IFS= read -r file; do echo "$file" && cat "$file"; done
    ) | git hash-object --stdin
}

# Builds a tree object's scenes and links them as SIDE-2d and SIDE-3d.
build() {
    local side="$1" name dimension binary built
    check_out "$2"
    add_scenes
    name="$(key)"
    for dimension in $dimensions; do
        binary="$CARGO_TARGET_DIR/bin/$name-$dimension"
        if [ ! -x "$binary" ]; then
            built="$(cd "$tree" && cargo build --quiet --release --locked --package "avian_kernel$dimension" \
                --bench costs --message-format json-render-diagnostics |
                sed -n 's/.*"name":"costs".*"executable":"\([^"]*\)".*/\1/p')"
            cp "$built" "$binary.new"
            mv "$binary.new" "$binary"
        fi
        touch "$binary"
        ln "$binary" "$scratch/$side-$dimension"
    done
}

# Counts one scene. The environment is empty, as its length would move the stack.
count() {
    local binary="$scratch/$1-$2" out="$scratch/$1-$2-$3"
    env -i "$(command -v valgrind)" --quiet --tool=callgrind --callgrind-out-file="$out.callgrind" \
        --toggle-collect='*measured_steps*' "$binary" "$3" >"$out.digest" 2>"$out.errors" || return 0
    sed -n 's/^totals: //p' "$out.callgrind" >"$out.total"
}

# Counts all scenes on both sides, several at once.
count_all() {
    local jobs="${COST_JOBS:-$(nproc)}" dimension side scene
    for dimension in $dimensions; do
        while read -r scene _; do
            for side in base this; do
                while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n; done
                count "$side" "$dimension" "$scene" &
            done
        done < <("$scratch/this-$dimension")
    done
    wait
}

# Lines of dimension, scene, steps, totals of base and of this tree, and whether motion differs.
counts() {
    local dimension scene steps side out
    for dimension in $dimensions; do
        "$scratch/this-$dimension" | while read -r scene steps; do
            for side in base this; do
                out="$scratch/$side-$dimension-$scene"
                if ! grep -q '^[1-9]' "$out.total" 2>/dev/null; then
                    echo "$side, $dimension: $scene was not counted" >&2
                    cat "$out.errors" >&2
                    exit 1
                fi
            done
            out="$dimension-$scene"
            echo "$dimension $scene $steps $(cat "$scratch/base-$out.total" "$scratch/this-$out.total" | xargs)" \
                "$(cmp -s "$scratch/base-$out.digest" "$scratch/this-$out.digest" && echo same || echo moved)"
        done
    done
}

# The table, with the geometric mean of each dimension. Fails if a scene at rest is over the limit.
table() {
    awk -v limit="$limit" '
        function mean() {
            if (n) printf "%-4s %-18s %12s %12s %8.3f\n\n", dimension, "geometric mean", "", "", exp(sum / n)
            n = sum = 0
        }
        BEGIN { printf "%-4s %-18s %12s %12s %8s\n", "", "1000 a step", "base", "now", "ratio" }
        $1 != dimension { mean(); dimension = $1 }
        {
            ratio = $5 / $4
            n++; sum += log(ratio)
            over = limit != "" && $2 ~ /^resting/ && ratio > 1 + limit / 100
            if (over) failed = 1
            printf "%-4s %-18s %12.1f %12.1f %8.3f%s%s\n", $1, $2, $4 / $3 / 1000, $5 / $3 / 1000, ratio, \
                $6 == "moved" ? " *" : "", over ? " over the limit" : ""
        }
        END { mean(); exit failed }
    '
}

# Two runs at once would change the folder below each other.
wait_for_others() {
    command -v flock >/dev/null || return 0
    exec 9>"$CARGO_TARGET_DIR/cost.lock"
    flock --nonblock 9 && return
    echo "waiting for another run in $CARGO_TARGET_DIR" >&2
    flock 9
}

main() {
    wait_for_others
    scratch="$(mktemp -d "$CARGO_TARGET_DIR/run.XXXXXX")"
    trap 'rm -rf "$scratch"' EXIT
    here="$(tree_here)"
    if [ -z "$base" ]; then
        base=HEAD
        [ "$here" != "$(git rev-parse 'HEAD^{tree}')" ] || base=HEAD~1
    fi
    local there
    there="$(git rev-parse --verify --quiet "$base^{tree}")" || fail "no such commit: $base"
    echo "this tree against $base: $(git log -1 --format='%h %s' "$base")"
    SECONDS=0
    build base "$there"
    build this "$here"
    local built=$SECONDS
    count_all
    counts >"$scratch/counts"
    # Binaries of the last few trees are kept.
    ls -t "$CARGO_TARGET_DIR"/bin/* | tail -n +17 | xargs -r rm
    table <"$scratch/counts" || { echo "over the limit of $limit %" >&2 && return 1; }
    echo "built in $built s, counted in $((SECONDS - built)) s"
}

# In one line: a change of this file while it runs has no effect.
{ main; exit; }
