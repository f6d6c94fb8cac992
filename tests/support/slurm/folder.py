"""The files of a Slurm on loopback: configuration, ports, and the command line of each daemon."""

import json
import os
import pwd
import random
import socket

# CPUs and memory are what the file says, not what the machine has (config_overrides). Unlike the defaults, jobs start
# at once, a node that does not answer is down after seconds, and a cancelled job has 2 s from SIGTERM to SIGKILL.
CONF = """\
ClusterName=loopback
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={slurmctld}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CommunicationParameters=NoInAddrAny
MpiDefault=none
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool/%n
SlurmctldPidFile={folder}/slurmctld.run
SlurmdPidFile={folder}/%n.run
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
DefMemPerCPU=100
SchedulerParameters=batch_sched_delay=0,sched_interval=1,sched_min_interval=0,bf_interval=1
SlurmdParameters=config_overrides
ReturnToService=2
SlurmctldTimeout=5
SlurmdTimeout=5
KillWait=2
"""
NODE = 'NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cpus} RealMemory=64000\n'


def free_ports(count):
    """Ports below those that the kernel gives to outgoing connections."""
    ports = set()
    while len(ports) < count:
        port = random.randrange(20000, 32000)
        with socket.socket() as probe:
            if probe.connect_ex(('127.0.0.1', port)):
                ports.add(port)
    return list(ports)


def write_files(folder, nodes, cpus):
    names = [f'node{i + 1}' for i in range(nodes)]
    ports = dict(zip(['slurmctld'] + names, free_ports(nodes + 1)))
    host = socket.gethostname().split('.')[0]
    for name in ['state'] + [f'spool/{name}' for name in names]:
        (folder / name).mkdir(parents=True)
    conf = CONF.format(host=host, user=pwd.getpwuid(os.getuid()).pw_name, folder=folder, slurmctld=ports['slurmctld'])
    conf += ''.join(NODE.format(name=name, host=host, port=ports[name], cpus=cpus) for name in names)
    (folder / 'slurm.conf').write_text(conf + 'PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP\n')
    (folder / 'munge.key').write_bytes(os.urandom(128))
    (folder / 'munge.key').chmod(0o600)
    (folder / 'ports.json').write_text(json.dumps(ports))


def ports_of(folder):
    return json.loads((folder / 'ports.json').read_text())


def command(folder, name):
    if name == 'munged':  # --force: also in a folder that only its owner may enter
        files = {'key-file': 'key', 'socket': 'socket', 'pid-file': 'run', 'log-file': 'log', 'seed-file': 'seed'}
        return ['munged', '-F', '--force'] + [f'--{key}={folder}/munge.{end}' for key, end in files.items()]
    program = ['slurmctld'] if name == 'slurmctld' else ['slurmd', '-N', name]
    return program + ['-D', '-f', f'{folder}/slurm.conf']
