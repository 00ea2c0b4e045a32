# A Slurm of one machine, without systemd or anything in /etc: a controller and a node on loopback, with a munge of
# their own. Sourced.
# shellcheck shell=sh

have_slurm() {
    for command in munged slurmctld slurmd sbatch; do
        PATH=$PATH:/usr/sbin command -v $command >/dev/null 2>&1 || return 1
    done
}

# As in packages.sh.
provide_slurm() {
    provide 'Slurm' have_slurm slurm-wlm munge
}

# slurm_start DIR: brings Slurm up; DIR, which is made, takes all it writes. sbatch and its like then find it
# (SLURM_CONF). What went wrong is on standard error.
slurm_start() {
    slurm_dir=$1
    mkdir -p "$slurm_dir/state" "$slurm_dir/spool" "$slurm_dir/munge" || return 1
    # munge wants its socket to be within reach of all, and its key of nobody else.
    chmod 755 "$slurm_dir" "$slurm_dir/munge"
    (umask 077 && head -c 128 /dev/urandom >"$slurm_dir/munge/key") || return 1
    munged --force --key-file="$slurm_dir/munge/key" --socket="$slurm_dir/munge/socket" \
        --pid-file="$slurm_dir/munge/pid" --log-file="$slurm_dir/munge/log" --seed-file="$slurm_dir/munge/seed" ||
        return 1
    slurm_node=$(uname -n)
    slurm_node=${slurm_node%%.*}
    slurm_ports=$(free_ports) || return 1
    slurm_configuration >"$slurm_dir/slurm.conf"
    SLURM_CONF=$slurm_dir/slurm.conf
    export SLURM_CONF
    slurmctld || return 1
    if ! slurmd -N "$slurm_node"; then
        # A container may keep it from control groups, which it looks for unless told otherwise; old ones take no such word.
        printf 'CgroupPlugin=disabled\n' >"$slurm_dir/cgroup.conf"
        slurmd -N "$slurm_node" || { slurm_log && return 1; }
    fi
    slurm_looks=0
    until sinfo --noheader --format=%t 2>/dev/null | grep -q idle; do
        slurm_looks=$((slurm_looks + 1))
        [ $slurm_looks -lt 100 ] || { slurm_log && return 1; }
        sleep 0.2
    done
}

# Two ports that nobody uses.
free_ports() {
    python3 -c '
import socket
sockets = [socket.create_server(("127.0.0.1", 0)) for _ in range(2)]
print(*(socket.getsockname()[1] for socket in sockets))'
}

slurm_configuration() {
    cat <<END
ClusterName=check
SlurmctldHost=$slurm_node(127.0.0.1)
SlurmctldPort=${slurm_ports% *}
SlurmdPort=${slurm_ports#* }
CommunicationParameters=NoInAddrAny
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$slurm_dir/munge/socket
CredType=cred/munge
StateSaveLocation=$slurm_dir/state
SlurmdSpoolDir=$slurm_dir/spool
SlurmctldPidFile=$slurm_dir/slurmctld.pid
SlurmdPidFile=$slurm_dir/slurmd.pid
SlurmctldLogFile=$slurm_dir/slurmctld.log
SlurmdLogFile=$slurm_dir/slurmd.log
ProctrackType=proctrack/pgid
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_min_interval=20000,sched_interval=1
ReturnToService=2
NodeName=$slurm_node NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=1000 State=UNKNOWN
PartitionName=check Nodes=ALL Default=YES MaxTime=INFINITE State=UP
END
}

slurm_log() {
    tail -n 20 "$slurm_dir/slurmctld.log" "$slurm_dir/slurmd.log" >&2
}

# Cancels what still runs and takes Slurm down, as far as it is up. DIR can be removed then.
slurm_stop() {
    [ -n "${slurm_dir:-}" ] || return 0
    scancel --quiet --user="$(id -un)" >/dev/null 2>&1 && slurm_wait 30
    for slurm_pid_file in slurmd.pid slurmctld.pid munge/pid; do
        if slurm_pid=$(cat "$slurm_dir/$slurm_pid_file" 2>/dev/null) && kill "$slurm_pid" 2>/dev/null; then
            while kill -0 "$slurm_pid" 2>/dev/null; do sleep 0.1; done
        fi
    done
    slurm_dir=
}

# slurm_wait SECONDS: until no job is left in the queue, jobs that are being ended included.
slurm_wait() {
    slurm_looks=$(($1 * 10))
    while [ -n "$(squeue --noheader 2>/dev/null)" ]; do
        slurm_looks=$((slurm_looks - 1))
        [ $slurm_looks -gt 0 ] || { squeue >&2 && return 1; }
        sleep 0.1
    done
}
