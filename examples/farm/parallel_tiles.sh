#!/bin/bash
# One picture in tiles, several at a time, by GNU parallel where it is installed, else by xargs.
#
#   parallel_tiles.sh cloud.vdb cloud.exr 16 --spp 256
#   JOBS=4 parallel_tiles.sh scene.pbrt scene.exr 16
#
# Arguments: the volume or scene, the picture, the number of tiles, and options of `freepath render`.
# On several machines: parallel --sshlogin with a shared folder.
set -euo pipefail

input=$1 picture=$2 tiles=$3
shift 3
parts=$(mktemp -d "${picture%.*}.parts.XXXXXX")
trap 'rm -rf "$parts"' EXIT
jobs=${JOBS:-2}

if command -v parallel >/dev/null && parallel --version 2>/dev/null | grep -q GNU; then
  parallel --halt now,fail=1 -j "$jobs" \
    freepath render "$input" "$@" --tiles "{}/$tiles" -o "$parts/{}.film" --progress none \
    ::: $(seq 1 "$tiles")
else
  seq 1 "$tiles" | xargs -P "$jobs" -I '{}' \
    freepath render "$input" "$@" --tiles "{}/$tiles" -o "$parts/{}.film" --progress none
fi
freepath merge "$parts"/*.film -o "$picture"
