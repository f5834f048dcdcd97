#!/usr/bin/env bash
# A chart or a set of sweeps, cut in parts that an MPI launcher runs side by side, put together, and
# held against the run in one piece. The ranks do not talk to each other: any launcher that numbers
# its processes will do. Usage: examples/shards/mpi.sh [RANKS [FOLDER [STUDY...]]], where - in the
# place of studies charts the generated scenes alone (minutes instead of an hour).
# Needs Debian's openmpi-bin. As root mpirun wants OMPI_ALLOW_RUN_AS_ROOT=1 and
# OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 in the environment.
set -euo pipefail
cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.."
ranks="${1:-4}" folder="${2:-out/shards}"
gnomon="$PWD/build/gnomon" studies=("${@:3}")
if ((${#studies[@]} == 0)); then studies=(examples/study.toml); fi
if [[ "${studies[0]}" == - ]]; then studies=(); fi

# in_parts COMMAND ARG...: one process a part, each with a thread, then the merge.
in_parts() {
  # shellcheck disable=SC2016  # the rank's own variables
  mpirun --oversubscribe -n "$ranks" bash -c '
    exec "$@" --threads 1 --shard "$((OMPI_COMM_WORLD_RANK + 1))/$OMPI_COMM_WORLD_SIZE"
  ' rank "$gnomon" "$@" --out "$folder/parts"
  "$gnomon" "$1" --merge --out "$folder/parts"
}

# Errors only (--frames 0): times are no bytes that two runs could share.
in_parts chart "${studies[@]}" --frames 0
"$gnomon" chart "${studies[@]}" --frames 0 --out "$folder/whole"
in_parts stability --only camera-in-volume
"$gnomon" stability --only camera-in-volume --out "$folder/whole"

for file in chart.json chart.csv chart.html stability.json stability.csv stability.html; do
  cmp "$folder/whole/$file" "$folder/parts/$file"
done
diff -r "$folder/whole/pictures" "$folder/parts/pictures"
echo "the parts of $ranks ranks are the whole run, to the byte"
