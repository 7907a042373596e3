#!/bin/bash
# One picture by an array job of Slurm: each task renders a range of samples, and goes on with what it
# had where it was preempted. Whoever ends last merges.
#
#   sbatch --array=0-15 --requeue --signal=TERM@60 slurm_array.sh cloud.vdb cloud.exr 1024
#
# Arguments: the volume or scene, the picture, its samples, and options of `freepath render`.
#SBATCH --cpus-per-task=8
#SBATCH --time=02:00:00
set -euo pipefail

input=$1 picture=$2 samples=$3
shift 3
task=${SLURM_ARRAY_TASK_ID:?start this as an array job}
first_task=${SLURM_ARRAY_TASK_MIN:-0}
tasks=${SLURM_ARRAY_TASK_COUNT:?start this as an array job}
number=$((task - first_task))
begin=$((samples * number / tasks))
end=$((samples * (number + 1) / tasks - 1))
parts=${picture%.*}.parts
mkdir -p "$parts"
part=$parts/$number.film

if [ ! -e "$part" ]; then
  status=0
  freepath render "$input" "$@" --samples "$begin-$end" --threads "${SLURM_CPUS_PER_TASK:-0}" \
    -o "$part" --checkpoint "$parts/$number.checkpoint.film" --resume "$parts/$number.checkpoint.film" \
    --progress lines || status=$?
  # Ended early: Slurm starts the task again, which goes on with the checkpoint.
  [ "$status" -eq 0 ] || exit "$status"
fi

# One task merges, whoever has the lock; one that is killed meanwhile leaves it, and is started again.
done_parts=("$parts"/*[0-9].film)
exec 9>"$parts/lock"
if [ "${#done_parts[@]}" -eq "$tasks" ] && flock -n 9 && [ ! -e "$parts/merged" ]; then
  freepath merge "${done_parts[@]}" -o "$picture"
  touch "$parts/merged"
fi
