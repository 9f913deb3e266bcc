#!/usr/bin/env python3
"""What check.sh measured, as JSON.

usage: figures.py write LOGS RUN DEVICE       its figures, from the logs of its steps and the trainings in RUN
       figures.py same LOG LOG                whether two trainings had the same losses to the last bit
       figures.py agreement FEATURES.h5...    how far features lie apart; fails where it is more than a thousandth of the largest
"""
import importlib.util
import json
import os
import pathlib
import subprocess
import sys


def text(path):
    return path.read_text(errors='replace') if path.exists() else ''


def parsed(path):
    return json.loads(text(path))


def read_with(read, *of):
    """None where the step that should have written it did not end."""
    try:
        return read(*of)
    except (IndexError, KeyError, OSError, TypeError, ValueError):
        return None


def gpu():
    try:
        asked = ['nvidia-smi', '--query-gpu=name,driver_version,memory.total', '--format=csv,noheader']
        said = subprocess.run(asked, capture_output=True, text=True, timeout=60)
    except (OSError, subprocess.TimeoutExpired):
        return {}
    if said.returncode or not said.stdout.strip():
        return {}
    return dict(zip(('gpu', 'driver', 'memory'), said.stdout.splitlines()[0].split(', ')))


def torch_versions():
    """PyTorch's and its CUDA's, from its file of versions: importing it takes seconds, and this is asked after every step."""
    found = importlib.util.find_spec('torch')
    versions = {}
    if found:
        exec((pathlib.Path(found.origin).parent / 'version.py').read_text(), versions)
    return {'torch': versions.get('__version__'), 'cuda': versions.get('cuda')}


def machine(logs, device):
    out = {'gpu': None, 'driver': None, 'processors': os.cpu_count(), 'device': device, **gpu()}
    out.update(torch_versions())
    out['program'] = text(logs / 'version.out').splitlines()
    out['opencl'] = [{key: d[key] for key in ('name', 'type', 'driver')} for d in read_with(parsed, logs / 'devices.out') or []]
    return out


def steps(logs):
    out = []
    for line in text(logs / 'steps.tsv').splitlines():
        name, code, seconds, said = line.split('\t', 3)
        out.append({'name': name, 'exit': int(code), 'seconds': float(seconds)})
        if int(code):
            out[-1]['said'] = said
        backtrace = logs / f'{name}.backtrace'
        if backtrace.exists():
            out[-1]['backtrace'] = [line for line in text(backtrace).splitlines() if line.startswith('#')]
    return out


def kernels(path):
    report = parsed(path)
    cases = [(suite['name'] + '.' + case['name'], case) for suite in report['testsuites'] for case in suite['testsuite']]
    return {'tests': len(cases), 'skipped': sum(case['result'] == 'SKIPPED' for _, case in cases),
            'failed': [name for name, case in cases if 'failures' in case]}


def training(log):
    """Steps a second, without the first epoch, in which much is made that is made once."""
    epochs = [json.loads(line) for line in text(log).splitlines()]
    last, later = epochs[-1], epochs[1:] or epochs
    steps_a_second = last['step'] / last['epoch'] * len(later) / sum(epoch['seconds'] for epoch in later)
    kept = ('step', 'epoch', 'loss', 'discriminator_loss', 'generator_loss')
    return {'steps_a_second': steps_a_second, **{key: last[key] for key in kept if key in last}}


def bench_train(path):
    said = parsed(path)
    return {'device': said['device'], 'steps_a_second': 1 / said['step']['seconds'], 'motions_a_second': 100 / said['100 motions']['seconds']}


def features(path):
    said = parsed(path)
    return {key: said[key] for key in ('device', 'sequences_a_second', 'batch', 'frames', 'share_of_peak')}


def pytorch(path):
    step, _, generation, _ = map(float, text(path).split())
    return {'steps_a_second': 1 / step, 'motions_a_second': 100 / generation}


def write(logs, run, device):
    def each(begin, end, read):
        """Of all steps called `begin`..., what `read` makes of what they left."""
        return {path.name[len(begin):-len(end)]: read_with(read, path) for path in sorted(logs.glob(begin + '*' + end))}

    return {
        'machine': machine(logs, device),
        'steps': steps(logs),
        'kernels': each('kernels-', '.json', kernels),
        'cuda': read_with(kernels, logs / 'cuda.json'),
        'features': each('features-', '.out', features),
        'training': {log.parent.name: read_with(training, log) for log in sorted(run.glob('*/log.jsonl'))},
        'bench_train': each('bench-train-', '.out', bench_train),
        'pytorch': each('pytorch-', '.out', pytorch),
        'same_losses_with_and_without_graphs': read_with(parsed, logs / 'same-losses.out'),
        'agreement': read_with(parsed, logs / 'agreement.out'),
    }


def same(logs):
    losses = [[[epoch[key] for key in ('discriminator_loss', 'generator_loss')] for epoch in map(json.loads, text(pathlib.Path(log)).splitlines())]
              for log in logs]
    alike = bool(losses[0]) and losses[0] == losses[1]
    print(json.dumps(alike))
    return not alike


def agreement(files):
    import h5py
    import numpy
    features = {pathlib.Path(name).stem: h5py.File(name, 'r')['features'][()] for name in files}
    names = list(features)
    apart = {f'{a} and {b}': float(numpy.abs(features[a] - features[b]).max() / numpy.abs(features[b]).max())
             for i, a in enumerate(names) for b in names[i + 1:]}
    print(json.dumps(apart))
    return not all(value <= 1e-3 for value in apart.values())


def main(arguments):
    if arguments[:1] == ['agreement']:
        return agreement(arguments[1:])
    if arguments[:1] == ['same'] and len(arguments) == 3:
        return same(arguments[1:])
    if arguments[:1] != ['write'] or len(arguments) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    print(json.dumps(write(pathlib.Path(arguments[1]), pathlib.Path(arguments[2]), arguments[3]), indent=1))
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
