#!/usr/bin/python3
"""Runs the reference program csgn.py in this process: weights, input and forward pass of every case, gradients included.

usage: oracle.py CSGN.PY FOLDER CASE...      CASE: NAME:OPTION=VALUE,OPTION=VALUE...

FOLDER gets NAME-weights.h5, NAME-input.h5 and NAME-out.h5; the last holds `grad/NAME` beside what csgn.py writes itself.
"""
import contextlib, importlib.util, io, sys
import h5py, torch


def load(path):
    spec = importlib.util.spec_from_file_location("csgn", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def call(module, *words):
    sys.argv = ["csgn.py", *words]
    with contextlib.redirect_stdout(io.StringIO()):
        module.main()


def main(path, folder, cases):
    module = load(path)
    nets, taken = [], {}
    init, generate, grad = module.Net.__init__, module.Net.G, torch.autograd.grad

    def remember(self, *arguments):
        init(self, *arguments)
        nets.append(self)

    def padded(self, z, y, train=True):
        """A node of translation has three numbers; those behind are zeros, as in real motions."""
        x = generate(self, z, y, train)
        if self.c.skeleton == "smpl":
            kept = torch.ones(x.shape[1:3] + (1,), dtype=x.dtype)
            for person in range(self.c.persons):
                kept[6 * person + 3:6 * person + 6, -1] = 0
            x = x * kept
        return x

    def gradients(loss, weights, **options):
        names = {id(weight): name for name, weight in nets[-1].w.items()}
        found = grad(loss, weights, **options)
        taken.update({names[id(weight)]: value for weight, value in zip(weights, found)})
        return found

    module.Net.__init__, module.Net.G, torch.autograd.grad = remember, padded, gradients
    for case in cases:
        name, options = case.split(":")
        options = dict(option.split("=") for option in options.split(","))
        words = [word for key, value in options.items() for word in ("--" + key, value)]
        weights, given, out = (f"{folder}/{name}-{part}.h5" for part in ("weights", "input", "out"))
        call(module, "weights", weights, *words)
        call(module, "input", given, *words)
        call(module, "forward", weights, given, out, "--double", *words)
        with h5py.File(out, "a") as file:
            for key, value in taken.items():
                file["grad/" + key] = value.numpy()
        taken.clear()


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], sys.argv[3:])
