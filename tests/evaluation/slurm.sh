#!/bin/bash
# Runs a command with a Slurm of one machine: a controller and a node with all its processors, in a folder of their own, for this
# user alone. Nothing of the system's own Slurm is touched, and nothing is left behind.
#   tests/evaluation/slurm.sh COMMAND...
# Needs Debian's slurmctld, slurmd and slurm-client. Exit status: the command's; 77 without Slurm, or where its daemons do not start.
set -u
PATH=$PATH:/usr/sbin
for program in slurmctld slurmd sbatch; do
  command -v $program >/dev/null || { echo "slurm.sh: $program is not installed (apt-get install slurmctld slurmd slurm-client)" >&2; exit 77; }
done
work=$(mktemp -d) || exit 1
controller= node=
stop() {
  for process in $node $controller; do
    kill "$process" 2>/dev/null && wait "$process" 2>/dev/null
  done
  rm -rf "$work"
}
trap stop EXIT
trap 'exit 130' INT TERM

host=$(hostname -s)
first=$((20000 + $$ % 20000))
processors=$(nproc)
mkdir "$work/state" "$work/spool"
cat >"$work/slurm.conf" <<CONF
ClusterName=evaluation
SlurmctldHost=$host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
SlurmctldPort=$first
SlurmdPort=$((first + 1))
AuthType=auth/none
CredType=cred/none
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$processors
PartitionName=all Nodes=$host Default=YES State=UP MaxTime=INFINITE
CONF
# Control groups are not used. Before release 23 no setting says so, but a version that is named is not looked for in /sys.
plugin=disabled
[ "$(slurmd -V | sed 's/[^0-9]*\([0-9]*\).*/\1/')" -ge 23 ] || plugin=cgroup/v1
echo "CgroupPlugin=$plugin" >"$work/cgroup.conf"
export SLURM_CONF=$work/slurm.conf
slurmctld -D -f "$SLURM_CONF" >"$work/out" 2>&1 &
controller=$!
slurmd -D -f "$SLURM_CONF" >>"$work/out" 2>&1 &
node=$!
for _ in $(seq 150); do
  sinfo --noheader --format=%t 2>/dev/null | grep -qx idle && ready=1 && break
  kill -0 $controller 2>/dev/null && kill -0 $node 2>/dev/null || break
  sleep 0.2
done
if [ -z "${ready:-}" ]; then
  echo "slurm.sh: Slurm does not start on this machine:" >&2
  tail -n 5 "$work/out" "$work"/*.log >&2
  exit 77 # its daemons ask more of a machine than this one has, as in a chroot
fi
"$@"
