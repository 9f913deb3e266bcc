#!/usr/bin/env bash
# A Slurm of one node, for a test: all of it in one folder, nothing of the machine's own Slurm touched; also as root in a container without systemd.
set -euo pipefail

die() { echo "one_node.sh: $*" >&2; exit 1; }

usage() {
    cat >&2 <<'USAGE'
usage: tests/slurm/one_node.sh start | stop DIR

  tests/slurm/one_node.sh start /tmp/slurm
  SLURM_CONF=/tmp/slurm/slurm.conf sinfo
  tests/slurm/one_node.sh stop /tmp/slurm

It needs apt-get install --no-install-recommends slurm-wlm munge.
USAGE
    exit 2
}

# The daemons lie in sbin, which is not in everyone's PATH.
PATH=$PATH:/usr/sbin:/sbin

free_port() { # from
    local port=$1
    while (: <>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
    echo "$port"
}

write_conf() {
    local host control node
    host=$(hostname -s)
    control=$(free_port 26817)
    node=$(free_port $((control + 1)))
    cat >"$dir/slurm.conf" <<CONF
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$control
SlurmdPort=$node
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$dir/munge.socket
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool
SlurmctldPidFile=$dir/slurmctld.pid
SlurmdPidFile=$dir/slurmd.pid
SlurmctldLogFile=$dir/slurmctld.log
SlurmdLogFile=$dir/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
MailProg=/bin/true
ReturnToService=2
KillWait=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
}

alive() { # pid file
    local pid
    pid=$(cat "$1" 2>/dev/null) && [ -n "$pid" ] && kill -0 "$pid" 2>/dev/null
}

start() {
    local program
    for program in munged slurmctld slurmd sinfo; do
        command -v "$program" >/dev/null ||
            die "no $program; install it: apt-get install --no-install-recommends slurm-wlm munge"
    done
    mkdir -p "$dir"
    for program in munged slurmctld slurmd; do
        ! alive "$dir/$program.pid" || die "$dir: its $program runs already; stop it first"
    done
    mkdir -p -m 700 "$dir/state" "$dir/spool"
    (umask 077 && head -c 128 /dev/urandom >"$dir/munge.key")
    # --force: the folder is often below /tmp, which munged would rather not have.
    munged --force --key-file "$dir/munge.key" --socket "$dir/munge.socket" --pid-file "$dir/munged.pid" \
        --log-file "$dir/munged.log" --seed-file "$dir/munged.seed" 2>"$dir/munged.said" || { cat "$dir/munged.said" >&2; die "munged does not start"; }
    write_conf
    export SLURM_CONF=$dir/slurm.conf
    slurmctld -c || { stop; die "slurmctld does not start; see $dir/slurmctld.log"; }
    slurmd || { stop; die "slurmd does not start; see $dir/slurmd.log"; }
    local i
    for ((i = 0; i < 150; ++i)); do
        if sinfo --noheader --format %t 2>/dev/null | grep -qx idle; then
            echo "a Slurm of one node is up, $(nproc) processors; SLURM_CONF=$SLURM_CONF leads to it"
            return
        fi
        sleep 0.2
    done
    stop
    die "the node did not come up in 30 s; see $dir/slurmctld.log and $dir/slurmd.log"
}

# Jobs first: their processes are not the daemons' to end.
stop() {
    export SLURM_CONF=$dir/slurm.conf
    if alive "$dir/slurmctld.pid"; then
        timeout 10 scancel --user "$(id -un)" 2>/dev/null || true
        local i
        for ((i = 0; i < 50; ++i)); do
            [ -n "$(timeout 10 squeue --noheader 2>/dev/null)" ] || break
            sleep 0.2
        done
    fi
    local daemon
    for daemon in slurmd slurmctld munged; do end "$daemon"; done
}

end() { # daemon
    local file=$dir/$1.pid pid i
    alive "$file" || return 0
    pid=$(cat "$file")
    [ "$(cat "/proc/$pid/comm" 2>/dev/null)" = "$1" ] || return 0 # an old file, and the number is another's by now
    kill "$pid"
    for ((i = 0; i < 100; ++i)); do
        kill -0 "$pid" 2>/dev/null || return 0
        sleep 0.1
    done
    die "$1 ($pid) does not end; see $dir/$1.log"
}

[ $# = 2 ] || usage
dir=$(realpath -m "$2")
[[ $dir != *[[:space:]]* ]] || die "$dir: slurm.conf knows no folder with a space in its name; choose another"
case $1 in
    start) start ;;
    stop) [ -e "$dir/slurm.conf" ] || die "$dir: no Slurm was started there"; stop; echo "stopped" ;;
    *) usage ;;
esac
