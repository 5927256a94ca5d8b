#!/usr/bin/env bash
# Makes the Debian package, and uses what is in it: the program, its manual page, its completion and its samples.
#   package_test.sh BUILD_DIR [all]      all: also installs it (needs root) and runs the whole sample
set -euo pipefail
build=$(cd "$1" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() { echo "package_test: $*" >&2 && exit 1; }

cpack --config "$build/CPackConfig.cmake" -B "$scratch/cpack" >"$scratch/cpack.log" 2>&1 ||
  { cat "$scratch/cpack.log" && fail "cpack failed"; }
package=$(echo "$scratch"/cpack/drape_*.deb)
depends=$(dpkg-deb --field "$package" Depends)
for library in libc6 libosmesa6 libopencv-imgproc libmpfr6 libtbb12 libmeshoptimizer; do
  [[ $depends == *"$library"* ]] || fail "does not depend on $library: $depends"
done
dpkg-deb --extract "$package" "$scratch/root"
if [ "$EUID" -eq 0 ] && command -v apt-get >/dev/null; then
  # Every package that it depends on exists, in the version asked for.
  apt-get install --simulate "$package" >"$scratch/apt.log" 2>&1 || { cat "$scratch/apt.log" && fail "cannot be installed"; }
fi
usr=$scratch/root/usr
if [ "${2:-}" = all ]; then
  dpkg --install "$package"
  trap 'dpkg --remove drape; rm -rf "$scratch"' EXIT
  usr=/usr
fi

"$usr/bin/drape" --version | grep -q '^drape [0-9]' || fail "no version"
page=$usr/share/man/man1/drape.1
if command -v groff >/dev/null; then
  complaints=$(zcat -f "$page"* | groff -man -Tutf8 -ww 2>&1 >"$scratch/page.txt")
  [ -z "$complaints" ] || fail "manual page: $complaints"
  grep -q 'drape batch submit' "$scratch/page.txt" || fail "the manual page lacks commands"
fi

completions() {  # completions WORD...: what TAB offers after these words
  bash -c 'source "$1"; shift; compopt() { :; }; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _drape; echo "${COMPREPLY[*]}"' \
    bash "$usr/share/bash-completion/completions/drape" "$@"
}
expect() {  # expect EXPECTED WORD...
  local expected=$1 offered
  shift
  offered=$(completions "$@")
  [ "$offered" = "$expected" ] || fail "after '$*' TAB offers '$offered' instead of '$expected'"
}
expect "run" drape ru
expect "run" drape batch r
expect "--until" drape run config.yaml --unt
expect "--executor" drape batch submit --ex
expect "register" drape run config.yaml --from re
expect "texture.mode=" drape run config.yaml --set texture.mod
expect "" drape run config.yaml --workspace re

examples=$usr/share/doc/drape/examples
last=(--until register)
[ "${2:-}" != all ] || last=()
"$usr/bin/drape" --quiet run "$examples/config/teapot.yaml" --workspace "$scratch/workspace" --set "output=$scratch/model" \
  "${last[@]}"
[ -s "$scratch/workspace/runs/teapot/2-register/poses.json" ] || fail "the sample did not run"
[ "${2:-}" != all ] || [ -s "$scratch/model/model.glb" ] || fail "the sample made no model"
