#!/usr/bin/env bash
# Runs every command that the documents show: all ```sh blocks of the pages given, in order, each page in one shell.
#   documented_commands.sh PROGRAM BUILD_DIR PAGE...
# Files that the pages put into /tmp/drape-readme go to a scratch folder. scripts/test is left out: it runs this.
set -euo pipefail
program=$1
build=$2
shift 2
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/bin"
ln -s "$program" "$scratch/bin/drape"

for page in "$@"; do
  awk '/^```sh$/ {inside = 1; next} /^```$/ {inside = 0} inside' "$page" |
    grep -v -x 'scripts/test' |
    sed -e "s#/tmp/drape-readme#$scratch#g" \
      -e "s#^scripts/demo\$#scripts/demo --workspace $scratch/workspace --set output=$scratch/model#" \
      -e 's#^export PATH=.*#true#' >"$scratch/commands"
  count=$(grep -c . "$scratch/commands" || true)
  [ "$count" -gt 0 ] || { echo "$page: shows no command" && exit 1; }
  echo "== $page: $count commands"
  DRAPE_BUILD_DIR=$build PATH="$scratch/bin:$PATH" bash -euxo pipefail "$scratch/commands"
done
for file in model/model.glb mine-model/model.glb teapot/truth.json first/model/model.glb; do
  [ -s "$scratch/$file" ] || { echo "$file was not made" && exit 1; }
done
