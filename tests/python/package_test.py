#!/usr/bin/python3
"""The Python package against the program: files that it makes, and joints that it exports.

usage: package_test.py PROGRAM SOURCE_FOLDER         (77: skipped)
"""
import doctest, errno, importlib.util, inspect, json, os, pickle, re, stat, subprocess, sys, tempfile, unittest
from unittest import mock

if len(sys.argv) != 3:
    sys.exit(__doc__)
PROGRAM, SOURCE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
try:
    import h5py, numpy as np
except ImportError as missing:
    print(f"skipped: no {missing.name} in {sys.executable}")
    sys.exit(77)
sys.path.insert(0, os.path.join(SOURCE, "python"))
sys.dont_write_bytecode = True
import actformer
from actformer import Body, Dataset, Error, Motion, Motions, read_features, read_scores, write_motions

CAN_TRAIN = os.path.exists(os.path.join(os.path.dirname(PROGRAM), "actformer-train"))
# Both sides compute in double and round to float32 once: at most half a unit in the last place each, 2.4e-7 below 4 m.
ROUNDING = 5e-7


def run(*words):
    done = subprocess.run([PROGRAM, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode:
        raise AssertionError(f"{' '.join(words)}: {done.stderr}")
    return done.stdout


def make_inputs():
    """Small files of every kind, in the working directory."""
    run("synth", "ntu", "-o", "raw", "--clips", "24", "--actions", "9,10,50", "--seed", "1")
    run("ingest", "ntu", "raw", "-o", "ntu")
    run("synth", "humanact12", "-o", "acts", "--clips", "12", "--seed", "1")
    run("ingest", "humanact12", "acts", "-o", "rotations")
    run("ingest", "humanact12", "acts", "-o", "positions", "--representation", "xyz")
    run("export", "ntu/ntu-1p", "-o", "motions.h5")
    if CAN_TRAIN:
        run("train", "recogniser", "-c", f"{SOURCE}/model/configs/recogniser-small.yaml", "--data", "ntu/ntu-1p", "-o", "run",
            "epochs=1", "train_split=all", "test_split=all")
        run("features", "--recogniser", "run", "motions.h5", "-o", "features.h5")
        run("score", "--recogniser", "run", "--real", "ntu/ntu-1p", "--generated", "motions.h5", "-o", "scores.json")


def exported(source, name):
    run("export", source, "-o", name)
    return np.load(name)


def stick(representation="xyz"):
    lengths = np.array([[0, 0.5, 0.25]], np.float32) if representation == "limb" else None
    return Body(representation, ("hip", "chest", "head"), (-1, 0, 1), bone_length=lengths)


def walk(frames=20, persons=1):
    values = np.zeros((frames, persons, 3, 3), np.float32)
    values[..., 1] = [0.9, 1.4, 1.65]
    values[..., 0] = np.linspace(0, 1, frames)[:, None, None]
    return values


class Datasets(unittest.TestCase):
    def test_joints_are_those_that_the_program_exports(self):
        for folder in ("ntu/ntu-1p", "ntu/ntu-2p", "rotations", "positions"):
            with Dataset(folder) as data, exported(folder, "joints.npz") as joints:
                self.assertEqual([c.name for c in data], list(joints["clips"]))
                self.assertEqual([c.label for c in data], list(joints["labels"]))
                self.assertEqual(list(data.body.names), list(joints["names"]))
                for clip in data:
                    np.testing.assert_allclose(data.joints(clip), joints[clip.name], rtol=0, atol=ROUNDING)

    def test_header(self):
        data = Dataset("ntu/ntu-2p")
        told = json.loads(run("inspect", "ntu/ntu-2p", "--json"))
        told = told[0] if isinstance(told, list) else told.get("datasets", [told])[0]
        self.assertEqual(len(data), told["clips"])
        self.assertEqual((data.name, data.persons, data.fps, data.representation), ("ntu-2p", 2, 30.0, "limb"))
        self.assertEqual({clip.class_name for clip in data}, {data.classes[0]})  # action 50, the first of two persons

    def test_splits_are_the_programs(self):
        data = Dataset("ntu/ntu-1p")
        for split in ("all", *data.splits):
            names = sorted(clip.name for clip in data.clips(split))
            if not names:
                continue
            run("export", "ntu/ntu-1p", "--split", split, "-o", "split.npz")
            with np.load("split.npz") as joints:
                self.assertEqual(names, sorted(joints["clips"]), split)
        performers = {clip.fields["performer"] for clip in data.clips("xsub/train")}
        self.assertFalse(performers & {clip.fields["performer"] for clip in data.clips("xsub/test")})

    def test_travels_to_another_process(self):
        data = Dataset("ntu/ntu-1p")
        before = data.motion(data[data.clips()[0].name])
        again = pickle.loads(pickle.dumps(data))
        np.testing.assert_array_equal(again.motion(again.clips()[0]), before)
        child = os.fork()
        if child == 0:  # reads with a file of its own
            os._exit(0 if np.array_equal(data.motion(data.clips()[0]), before) else 1)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        np.testing.assert_array_equal(data.motion(data.clips()[0]), before)


class MotionFiles(unittest.TestCase):
    def test_reads_what_export_writes(self):
        data, file = Dataset("ntu/ntu-1p"), Motions("motions.h5")
        self.assertEqual(file.classes, data.classes)
        for clip in data:
            # Names end in the label's number, as the published tools expect.
            motion = file[re.sub(r"\d{3}$", f"{clip.label + 1:03}", clip.name)]
            np.testing.assert_array_equal(motion.values, data.motion(clip))
            self.assertEqual(motion.label, clip.label)
            np.testing.assert_array_equal(file.joints(motion), data.joints(clip))

    def test_the_program_reads_what_is_written(self):
        for representation, source in (("limb", "ntu/ntu-2p"), ("rot6d", "rotations"), ("xyz", "positions")):
            data = Dataset(source)
            motions = [Motion(c.name, data.motion(c), c.label, data.bone_length(c)) for c in data]
            write_motions("mine.h5", motions, data.body_of(data.clips()[0]), data.classes, data.fps, source="a test")
            with exported("mine.h5", "mine.npz") as joints, exported(source, "theirs.npz") as expected:
                self.assertEqual(list(joints["classes"]), data.classes)
                self.assertEqual(float(joints["fps"]), data.fps)
                self.assertEqual(dict(zip(joints["clips"], joints["labels"])),
                                 dict(zip(expected["clips"], expected["labels"])))
                for clip in data:
                    np.testing.assert_array_equal(joints[clip.name], expected[clip.name], representation)
            self.assertEqual(Motions("mine.h5").representation, representation)

    def test_ones_own_skeleton_is_drawn_and_ingested(self):
        write_motions("walks.h5", [Motion(f"A001_{i}", walk(), 0) for i in range(3)], stick(), ["gehen: müde"], fps=25)
        run("ingest", "motions", "walks.h5", "-o", "walks")
        data = Dataset("walks")
        self.assertEqual((data.classes, data.fps, data.body.names), (["gehen: müde"], 25.0, ("hip", "chest", "head")))
        self.assertEqual(len(data), 3)

    def test_persons_without_lengths_of_their_own_are_as_long_as_the_first(self):
        limbs = np.zeros((4, 2, 3, 3), np.float32)
        limbs[..., 1:, 1] = 1
        write_motions("pair.h5", [Motion("A001_0", limbs)], stick("limb"))
        with exported("pair.h5", "pair.npz") as joints:
            self.assertEqual(joints["A001_0"][0, 1, 2].tolist(), [0, 0.75, 0])
        file = Motions("pair.h5")
        self.assertEqual(file.joints(file["A001_0"])[0, 1, 2].tolist(), [0, 0.75, 0])

    def test_files_of_other_tools(self):
        with h5py.File("theirs.h5", "w") as file:  # (P*C, K, T), no attributes
            file["A007_0"] = walk().transpose(1, 3, 2, 0).reshape(3, 3, 20)
        file = Motions("theirs.h5", representation="xyz")
        np.testing.assert_array_equal(file["A007_0"].values, walk())
        self.assertEqual(file["A007_0"].label, 6)
        np.testing.assert_array_equal(file.joints(file["A007_0"], stick()), walk())


class Results(unittest.TestCase):
    def setUp(self):
        if not CAN_TRAIN:
            self.skipTest("built without libtorch")

    def test_features(self):
        seen = read_features("features.h5")
        with h5py.File("features.h5") as file:
            np.testing.assert_array_equal(seen.features, file["features"][()])
            self.assertEqual(seen.logits.shape, (16, 94))
        self.assertEqual(sorted(seen.names), Motions("motions.h5").names)
        told = json.loads(run("features", "--recogniser", "run", "motions.h5", "-o", "again.h5", "--json"))
        right = (seen.logits.argmax(1) == seen.labels).mean()  # the program's is over all sequences
        self.assertAlmostEqual(told["accuracy"], right, places=6)

    def test_scores(self):
        scores = read_scores("scores.json")
        with open("scores.json") as file:
            told = json.load(file)
        for name in ("accuracy", "fid_mean", "fid_whole", "diversity"):
            self.assertEqual(scores[name].mean, told[name]["mean"])
            self.assertEqual(scores[name].floor, told["floor"].get(name))
        self.assertEqual(scores["FIDm"], scores["fid_mean"])
        self.assertEqual(scores["root speed"], scores["root_speed"])
        self.assertNotIn("real", scores.metrics)
        self.assertNotIn("floor", scores.metrics)
        self.assertEqual(len(scores.confusion), 94)
        self.assertAlmostEqual(scores["accuracy"].mean, read_features("features.h5").accuracy(), places=6)


class Mistakes(unittest.TestCase):
    """Each gives one line with what is wrong, where, and what to do."""

    def refused(self, call, *words):
        with self.assertRaises(Error) as caught:
            call()
        text = str(caught.exception)
        self.assertNotIn("\n", text)
        for word in words:
            self.assertIn(word, text)

    def test_datasets(self):
        self.refused(lambda: Dataset("nowhere"), "nowhere", "actformer ingest")
        self.refused(lambda: Dataset("ntu"), "holds 2 datasets", "ntu/ntu-1p")
        self.refused(lambda: Dataset("motions.h5"), "motions.h5: a file; give a folder that actformer ingest made")
        self.refused(lambda: Dataset("ntu/ntu-1p").clips("xsub/tets"), "xsub/tets", "did you mean 'xsub/test'")
        self.refused(lambda: Dataset("ntu/ntu-1p").clips("q"), "there are all, xsub/")
        self.refused(lambda: Dataset("ntu/ntu-1p")["S1"], "no clip is called 'S1'")

    def test_damaged_datasets(self):
        for change, words in ((lambda d: d.update(format=9), ["dataset.json", "format 9"]),
                              (lambda d: d.pop("classes"), ["dataset.json", "classes", "ingest"]),
                              (lambda d: d.update(representation="quat"), ["'quat' is none of limb"]),
                              (lambda d: d["topology"]["parents"].__setitem__(3, 99), ["joint 3 has the parent 99"]),
                              (lambda d: d.pop("fields"), ["dataset.json", "fields", "ingest"]),
                              (lambda d: d["fields"].remove("performer"),
                               ["dataset.json", "split 'xsub/train' asks for 'performer'", "ingest"]),
                              (lambda d: d["shards"][0].update(file="../ntu/ntu-1p/shard-00000.h5"),
                               ["dataset.json", "shard '../ntu/ntu-1p/shard-00000.h5' is no file's name", "ingest"]),
                              (lambda d: d.update(persons=3), ["shard-00000.h5", "'motion'"])):
            subprocess.run(["rm", "-rf", "damaged"], check=True)
            subprocess.run(["cp", "-r", "ntu/ntu-1p", "damaged"], check=True)
            with open("damaged/dataset.json") as file:
                header = json.load(file)
            change(header)
            with open("damaged/dataset.json", "w") as file:
                json.dump(header, file)
            self.refused(lambda: Dataset("damaged"), *words)
        with open("damaged/dataset.json", "w") as file:
            file.write("{\n}}")
        self.refused(lambda: Dataset("damaged"), "dataset.json:2")
        subprocess.run(["cp", "ntu/ntu-1p/dataset.json", "damaged/"], check=True)
        os.truncate("damaged/shard-00000.h5", 5000)
        self.refused(lambda: Dataset("damaged"), "shard-00000.h5", "damaged")
        os.remove("damaged/shard-00000.h5")
        self.refused(lambda: Dataset("damaged"), "shard-00000.h5", "no such file")

    def test_motions(self):
        self.refused(lambda: Motions("ntu/ntu-1p/dataset.json"), "no HDF5 file")
        self.refused(lambda: Motions("ntu/ntu-1p"), "ntu/ntu-1p: a dataset, which Dataset('ntu/ntu-1p') opens; give a motions file")
        self.refused(lambda: Motions("ntu"), "ntu: a folder; give a motions file")
        self.refused(lambda: Motions("nowhere.h5"), "nowhere.h5: no such file; give a motions file")
        self.refused(lambda: Motions("motions.h5")["A001"], "no motion is called 'A001'")
        with h5py.File("bare.h5", "w") as file:
            file["A001_0"] = np.full((3, 4, 5), 0.3, np.float32)
        self.refused(lambda: Motions("bare.h5"), "no limb vectors", "representation='xyz'")
        file = Motions("bare.h5", "xyz")
        self.refused(lambda: file.joints(file["A001_0"]), "does not say how its nodes hang together", "body=")

    def test_writing(self):
        body = stick()
        mistakes = ((Motion("a", walk()[:, 0]), "is not (frames, persons, 3, 3)"),
                    (Motion("a/b", walk()), "no '/'"),
                    (Motion("a", walk(), 2), "label 2 is none of 1 classes"),
                    (Motion("a", np.full_like(walk(), np.nan)), "not finite"),
                    (Motion("a", walk(), 0, np.zeros((2, 3), np.float32)), "is not (1, 3)"))
        for motion, words in mistakes:
            self.refused(lambda: write_motions("bad.h5", [motion], body, ["walk"]), "bad.h5", words)
        self.refused(lambda: write_motions("bad.h5", [Motion("a", walk())] * 2, body), "two motions are called 'a'")
        self.refused(lambda: write_motions("bad.h5", [], body), "no motions are given")
        self.refused(lambda: write_motions("bad.h5", [Motion("a", walk())], stick("limb")), "'xyz'")
        self.refused(lambda: write_motions("no/folder/x.h5", [Motion("a", walk())], body), "no/folder/x.h5")
        self.assertEqual([name for name in os.listdir(".") if "bad" in name], [])  # nothing half is left

    def test_what_is_no_file_is_not_replaced(self):
        os.mkdir("places")
        one = [Motion("A001_0", walk())]
        write_motions("places/old.h5", one, stick())
        with open("places/victim", "w") as file:
            file.write("mine")
        os.symlink("victim", f"places/.new.h5.{os.getpid()}.partial")  # a name that could once be foreseen
        os.symlink("old.h5", "places/link.h5")
        os.symlink("/dev/null", "places/null.h5")
        os.mkfifo("places/pipe.h5")
        os.mkdir("places/folder.h5")
        before = sorted(os.listdir("places"))
        for name, kind in (("null.h5", "a device"), ("pipe.h5", "a FIFO"), ("folder.h5", "a folder")):
            self.refused(lambda: write_motions(f"places/{name}", one, stick()), f"places/{name}: {kind}", "another path")
        write_motions("places/link.h5", one, stick(), source="through a link")
        self.assertTrue(os.path.islink("places/link.h5"))
        with h5py.File("places/old.h5") as file:
            self.assertEqual(file.attrs["source"], b"through a link")
        self.assertEqual(sorted(os.listdir("places")), before)
        mask = os.umask(0o027)
        try:
            write_motions("places/new.h5", one, stick())
        finally:
            os.umask(mask)
        self.assertEqual(stat.S_IMODE(os.stat("places/new.h5").st_mode), 0o640)
        with open("places/victim") as file:
            self.assertEqual(file.read(), "mine")

    def test_written_files_are_on_the_disk_or_gone(self):
        os.mkdir("synced")
        one = [Motion("A001_0", walk())]
        with mock.patch("os.fsync") as sync:
            write_motions("synced/m.h5", one, stick())
        self.assertEqual(sync.call_count, 2)  # the file and its folder
        with open("synced/m.h5", "rb") as file:
            before = file.read()
        with mock.patch("os.fsync", side_effect=OSError(errno.EIO, "the disk is broken")):
            self.refused(lambda: write_motions("synced/m.h5", one, stick(), source="new"), "synced/m.h5: cannot be written",
                         "the disk is broken")

        def stopped():
            yield one[0]
            raise KeyboardInterrupt

        with self.assertRaises(KeyboardInterrupt):
            write_motions("synced/m.h5", stopped(), stick())
        with open("synced/m.h5", "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(os.listdir("synced"), ["m.h5"])

    def test_numbers_in_other_files(self):
        shape = (3, 3, 20)
        values = walk().transpose(1, 3, 2, 0).reshape(shape)
        with h5py.File("elsewhere.h5", "w") as file:
            file["A001_0"] = values

        def virtual(file):
            layout = h5py.VirtualLayout(shape, "f4")
            layout[:] = h5py.VirtualSource("elsewhere.h5", "A001_0", shape)
            file.create_virtual_dataset("A001_0", layout)

        def behind_a_soft_link(file):
            file["group/away"] = h5py.ExternalLink("elsewhere.h5", "/")
            file["A001_0"] = h5py.SoftLink("/group/away/A001_0")

        away = (("leads to another file", lambda f: f.update({"A001_0": h5py.ExternalLink("elsewhere.h5", "A001_0")})),
                ("leads to another file", behind_a_soft_link),
                ("is a virtual array", virtual),
                ("keeps its numbers in another file",
                 lambda f: f.create_dataset("A001_0", shape, "f4", external=[("numbers.bin", 0, h5py.h5f.UNLIMITED)])))
        for words, make in away:
            with h5py.File("away.h5", "w") as file:
                make(file)
            self.refused(lambda: Motions("away.h5", "xyz"), "away.h5: 'A001_0'", words, "copy")
            with h5py.File("away.h5", "r+") as file:
                file.move("A001_0", "features")
            self.refused(lambda: read_features("away.h5"), "away.h5: 'features'", words, "copy")
        with h5py.File("near.h5", "w") as file:  # links within a file are followed, but not in a circle
            file["A001_0"] = values
            file["A001_1"] = h5py.SoftLink("A001_0")
            file["A001_2"] = h5py.SoftLink("/A001_2")
        near = Motions("near.h5", "xyz")
        self.assertEqual(near.names, ["A001_0", "A001_1"])
        np.testing.assert_array_equal(near["A001_1"].values, walk())

    def test_datasets_with_numbers_in_other_files(self):
        subprocess.run(["cp", "-r", "ntu/ntu-1p", "away"], check=True)
        with h5py.File("away/shard-00000.h5", "r+") as file:
            del file["motion"]
            file["motion"] = h5py.ExternalLink("../ntu/ntu-1p/shard-00000.h5", "motion")
        self.refused(lambda: Dataset("away"), "shard-00000.h5: 'motion' leads to another file", "copy")

    def test_bodies(self):
        self.refused(lambda: Body("limbs", (), ()), "did you mean 'limb'")
        self.refused(lambda: Body("xyz", ("a", "b", "c"), (-1, 2, 1)), "no tree")
        self.refused(lambda: actformer.joint_positions(walk(), Body("limb", ("a", "b", "c"), (-1, 0, 1))), "bone_length")

    def test_scores_and_features(self):
        self.refused(lambda: read_scores("ntu/ntu-1p/dataset.json"), "no scores")
        self.refused(lambda: read_scores("nowhere.json"), "no such file", "actformer score")
        self.refused(lambda: read_scores("motions.h5"), "motions.h5: an HDF5 file, and JSON is expected", "actformer score")
        with open("noise.json", "wb") as file:
            file.write(b"\xff\xfe")
        self.refused(lambda: read_scores("noise.json"), "noise.json: no text in UTF-8", "actformer score")
        self.refused(lambda: read_scores("raw"), "raw: a folder; give the scores", "actformer score")
        self.refused(lambda: read_features("motions.h5"), "actformer features")
        self.refused(lambda: read_features("raw"), "raw: a folder; give the features", "actformer features")
        if CAN_TRAIN:
            self.refused(lambda: read_scores("scores.json")["fid_maen"], "did you mean 'fid_mean'")


class Package(unittest.TestCase):
    def test_examples_of_the_docstrings(self):
        count = 0
        for name in ("actformer", *("actformer." + m for m in ("body", "dataset", "motions", "features", "scores"))):
            module = sys.modules[name]
            if name.endswith(("features", "scores")) and not CAN_TRAIN:
                continue
            result = doctest.testmod(module)
            self.assertEqual(result.failed, 0, name)
            count += result.attempted
        self.assertGreater(count, 20)

    def test_everything_public_is_annotated(self):
        for name in actformer.__all__:
            item = getattr(actformer, name)
            functions = [f for _, f in inspect.getmembers(item, inspect.isfunction)] if inspect.isclass(item) else [item]
            for function in functions:
                if function.__code__.co_filename.startswith(SOURCE):  # and not what @dataclass makes
                    signature = inspect.signature(function)
                    self.assertIsNot(signature.return_annotation, inspect.Signature.empty, f"{name}: {function}")
                    for parameter in list(signature.parameters.values())[inspect.isclass(item):]:
                        self.assertIsNot(parameter.annotation, inspect.Signature.empty, f"{name}: {function}")
        self.assertTrue(os.path.exists(os.path.join(SOURCE, "python/actformer/py.typed")))

    def test_version_is_the_programs(self):
        self.assertIn(actformer.__version__, run("--version").split())
        with open(os.path.join(SOURCE, "python/pyproject.toml")) as file:
            self.assertIn(f'version = "{actformer.__version__}"', file.read())

    def test_pip_installs_it_without_a_network(self):
        if not all(map(importlib.util.find_spec, ("pip", "setuptools", "wheel"))):
            self.skipTest("no pip, setuptools and wheel in " + sys.executable)
        subprocess.run(["cp", "-r", os.path.join(SOURCE, "python"), "package"], check=True)
        done = subprocess.run([sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-index", "--no-deps",
                               "--target", "installed", "./package"], capture_output=True, text=True,
                              env={**os.environ, "PIP_ROOT_USER_ACTION": "ignore", "PIP_NO_CACHE_DIR": "1"})
        self.assertEqual(done.returncode, 0, done.stderr)
        there = subprocess.run([sys.executable, "-c", "import actformer; print(actformer.__file__)"], capture_output=True, text=True,
                               env={**os.environ, "PYTHONPATH": "installed"})
        self.assertIn("installed/actformer/__init__.py", there.stdout, there.stderr)
        self.assertTrue(os.path.exists("installed/actformer/py.typed"))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory(prefix="actformer-test-") as folder:
        os.chdir(folder)
        make_inputs()
        result = unittest.main(argv=[sys.argv[0]], exit=False).result
        os.chdir("/")
    sys.exit(not result.wasSuccessful())
