#!/bin/bash
# The frames of a sequence, for a queue that runs one command for each frame or chunk (OpenCue's
# #IFRAME#, Deadline's <STARTFRAME>-<ENDFRAME>), or in a loop. May be started again at any time: frames
# that are there are left out, and one that was killed goes on.
#
#   frames.sh 1-48 'smoke.%04d.vdb' 'picture.%04d.exr' --spp 256
#   for f in $(seq 1 48); do frames.sh $f 'smoke.%04d.vdb' 'picture.%04d.exr' --spp 256; done
#
# Arguments: frames, volumes, pictures, and options of `freepath render`.
set -euo pipefail

frames=$1 volumes=$2 pictures=$3
shift 3
checkpoint=${pictures%.*}.checkpoint.film
freepath render "$volumes" --frames "$frames" -o "$pictures" --skip-existing \
  --checkpoint "$checkpoint" --resume "$checkpoint" "$@"
