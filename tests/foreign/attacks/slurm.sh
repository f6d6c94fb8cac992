#!/bin/sh
# Stands in for Slurm's commands on a cluster with one node, this machine. It is copied as sbatch, squeue, scancel and sinfo to
# a folder of the PATH; the jobs are in the folder "jobs" beside them. As Slurm does with proctrack/linuxproc, it runs each job
# in a session of its own, and leaves processes alone that leave the session. It starts few processes, because it is called
# often.
set -u
name=${0##*/}
jobs=${0%/*}/jobs
if [ "${1-}" = --version ]; then
  echo "slurm 22.05.8"
  exit 0
fi

option() {
  case $1 in
    --job-name=*) job_name=${1#*=} ;;
    --chdir=*) folder=${1#*=} ;;
    --wrap=*) wrap=${1#*=} ;;
    --parsable) parsable=true ;;
    --test-only) exit 0 ;;
  esac
}

# A job has a folder: script, name (as soon as it runs), pid, status (as soon as it has ended), cancelled.
sbatch() {
  job_name='' folder=$PWD wrap='' parsable=false
  while [ $# -gt 0 ]; do
    case $1 in -*) option "$1" ;; *) break ;; esac
    shift
  done
  id=100
  while [ -e "$jobs/$id" ] || ! mkdir "$jobs/$id" 2>/dev/null; do id=$((id + 1)); done
  job=$jobs/$id
  if [ -n "$wrap" ]; then
    printf '#!/bin/sh\n%s\n' "$wrap" >"$job/script"
  else
    while IFS= read -r line; do
      printf '%s\n' "$line"
      case $line in "#SBATCH "*) option "${line#* }" ;; esac
    done <"$1" >"$job/script"
    shift
  fi
  cd "$folder" || exit 1
  export SLURM_JOB_ID="$id" SLURM_JOB_NAME="$job_name"
  setsid sh -c 'echo $$ >"$0/pid"; echo "$SLURM_JOB_NAME" >"$0/name.new"; mv "$0/name.new" "$0/name"
    sh "$0/script" "$@"; echo $? >"$0/status.new"; mv "$0/status.new" "$0/status"' "$job" "$@" \
    </dev/null >/dev/null 2>&1 3>&- 4>&- 5>&- 6>&- 7>&- 8>&- 9>&- &
  if $parsable; then echo "$id"; else echo "Submitted batch job $id"; fi
}

state_of() {
  state=RUNNING status=
  if [ -e "$1/status" ]; then
    read -r status <"$1/status"
    if [ "$status" = 0 ]; then state=COMPLETED; else state=FAILED; fi
  fi
  if [ -e "$1/cancelled" ]; then state=CANCELLED; fi
}

# Prints a line with the letters of squeue and sinfo: line FORMAT ID STATE NAME
line() {
  rest=$1 text=
  while [ "$rest" != "${rest#*%}" ]; do
    text=$text${rest%%\%*}
    rest=${rest#*%}
    case $rest in
      [iA]*) text=$text$2 ;;
      [Tt]*) text=$text$3 ;;
      j*) text=$text$4 ;;
      N*) text=${text}node1 ;;
      P*) text="${text}main*" ;;
      r*) text=${text}None ;;
    esac
    rest=${rest#?}
  done
  printf '%s\n' "$text$rest"
}

squeue() {
  format='%i %P %j %T %N %r' header=true
  for argument; do
    case $argument in
      --format=*) format=${argument#*=} ;;
      --noheader) header=false ;;
    esac
  done
  if $header; then echo "JOBS"; fi
  for path in "$jobs"/*/name; do
    [ -e "$path" ] || continue
    job=${path%/name}
    read -r job_name <"$path"
    state_of "$job"
    line "$format" "${job##*/}" "$state" "$job_name"
  done
}

scancel() {
  for id; do
    case $id in *[!0-9]* | '') continue ;; esac
    if [ -e "$jobs/$id/pid" ] && [ ! -e "$jobs/$id/status" ]; then
      read -r pid <"$jobs/$id/pid"
      : >"$jobs/$id/cancelled"
      kill -s KILL -- "-$pid"
    fi
  done
}

sinfo() {
  format='%N %T'
  for argument; do
    case $argument in --format=*) format=${argument#*=} ;; esac
  done
  line "$format" 0 idle none
}

"$name" "$@"
