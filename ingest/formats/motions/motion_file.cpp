#include "ingest/formats/motions/motion_file.hpp"

#include <map>
#include <set>
#include <unordered_map>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/numpy/npz.hpp"
#include "base/text/extension.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/motions/csv_motion.hpp"

namespace actformer::ingest {
namespace {

enum class Kind { npy, npz, csv, hdf5 };

Kind kind_of(std::string_view path) {
    const auto ends = [&](std::string_view extension) { return ends_in_extension(path, extension); };
    return ends(".npy")                   ? Kind::npy
           : ends(".npz")                 ? Kind::npz
           : ends(".h5") || ends(".hdf5") ? Kind::hdf5
                                          : Kind::csv;
}

/// Arrays of an .npz, or of an .h5, that tell about the motions and are none.
const std::set<std::string, std::less<>> telling{"clips",   "labels", "classes", "names",
                                                 "parents", "fps",    "program", "source"};

/// Error::what() without the file's name that some put before it.
std::string without_path(const Error& error, std::string_view path) {
    std::string why = error.what();
    if (const auto start = printable(path) + ": "; why.starts_with(start)) why.erase(0, start.size());
    return why;
}

NumpyArray array_of(const CsvMotion& motion) {
    NumpyArray array;
    array.size = sizeof(double);
    array.shape = {motion.frames, motion.persons, motion.joints, 3};
    array.values = {reinterpret_cast<const char*>(motion.positions.data()),
                    motion.positions.size() * sizeof(double)};
    return array;
}

class Look {
  public:
    Look(const RawText& raw, const ArrayReading& how) : raw_(raw), how_(how) {}

    MotionFile take() {
        try {
            look();
        } catch (const Error& e) {
            out_.faults.emplace_back("", without_path(e, raw_.path));
        }
        return std::move(out_);
    }

  private:
    void look() {
        switch (kind_of(raw_.path)) {
            case Kind::npy:
                return add("", read_npy(raw_.text), topology());
            case Kind::npz:
                return look_into_npz();
            case Kind::csv: {
                const auto motion = read_csv_motion(raw_.text, topology().names);
                FoundMotion found;
                found.persons = static_cast<std::uint32_t>(motion.persons);
                out_.motions.push_back(std::move(found));
                out_.numbered_columns = motion.numbered_columns;
                return;
            }
            case Kind::hdf5:
                return look_into_hdf5();
        }
    }

    const Topology& topology() const {
        if (how_.topology) return *how_.topology;
        if (out_.topology) return *out_.topology;
        throw Error(
            "it does not tell its skeleton; give --topology, as in --topology smpl24 or --topology "
            "skeleton.yaml");
    }

    void add(const std::string& key, const NumpyArray& array, const Topology& topology,
             std::vector<std::int64_t> labels = {}) {
        try {
            const JointArray joints(array, topology.joints(), how_.axes);
            if (joints.guessed() && out_.guess.empty())
                out_.guess = fmt::format("{} read as {}", array.shape_text(),
                                         joints.has_clips() ? "clips of frames" : "frames of persons");
            out_.motions.push_back({key, joints.clips(), joints.has_clips(),
                                    static_cast<std::uint32_t>(joints.persons()), false, std::move(labels)});
        } catch (const Error& e) {
            out_.faults.emplace_back(key, e.what());
        }
    }

    void look_into_npz() {
        std::vector<std::pair<std::string, NumpyArray>> arrays;
        std::map<std::string, std::vector<double>> numbers;
        std::map<std::string, std::vector<std::string>> texts;
        read_npz(raw_.text, {.heads_only = true}, [&](const std::string& name, const NumpyArray& array) {
            if (!telling.contains(name)) return void(arrays.emplace_back(name, array));
            if (array.values.empty()) return;
            if (array.numbers()) numbers[name] = array.all_numbers();
            if (array.kind == NumpyArray::Kind::text) texts[name] = array.all_texts();
        });
        out_.classes = texts["classes"];
        if (numbers["fps"].size() == 1 && numbers["fps"][0] > 0) out_.fps = numbers["fps"][0];
        if (!numbers["parents"].empty()) tell_topology(numbers["parents"], texts["names"]);
        if (arrays.empty()) throw Error("no array of joint positions in it");
        const auto& clips = texts["clips"];
        const auto& labels = numbers["labels"];
        std::unordered_map<std::string_view, std::size_t> place_of;
        for (std::size_t i = 0; i < clips.size(); ++i) place_of.emplace(clips[i], i);
        for (auto& [name, array] : arrays) {
            std::vector<std::int64_t> own;
            const auto at = place_of.find(name);
            if (at != place_of.end() && at->second < labels.size())
                own = {static_cast<std::int64_t>(labels[at->second])};
            if (clips.empty() && arrays.size() == 1) own.assign(labels.begin(), labels.end());
            add(arrays.size() == 1 && clips.empty() ? "" : name, array, topology(), std::move(own));
        }
    }

    void tell_topology(const std::vector<double>& parents, std::vector<std::string> names) {
        Topology told;
        for (const double parent : parents)
            told.parents.push_back(
                parent >= -1 && parent < static_cast<double>(parents.size()) ? static_cast<int>(parent) : -2);
        if (names.empty())
            for (std::size_t j = 0; j < parents.size(); ++j) names.push_back(std::to_string(j));
        for (const auto& name : names) told.names.push_back(printable(name));
        told.check("its parents and names");
        out_.topology = std::move(told);
    }

    void look_into_hdf5() {
        if (!raw_.on_disk)
            throw Error("an HDF5 file in an archive; unpack the archive and give the file itself");
        const std::string path(raw_.path);
        const hdf5::Reader file(path);
        std::vector<std::string> keys;
        for (auto& name : file.names())
            if (file.is_array(name) && !telling.contains(name)) keys.push_back(std::move(name));
        if (keys.empty()) throw Error("no array in it");
        const auto told = read_representation(file, path);
        if (auto subjects = read_subjects(file, path)) {
            out_.topology = subjects->topology;
            out_.classes = subjects->classes;
            out_.fps = subjects->fps;
            out_.bone_length = subjects->bone_length;
            out_.rest = subjects->rest;
        }
        bool first = true;
        for (const auto& key : keys) {
            const auto shape = file.shape(key);
            if (!told && holds_positions(file, key, shape)) {
                NumpyArray array;
                array.shape.assign(shape.begin(), shape.end());
                add(key, array, topology());
                continue;
            }
            if (std::exchange(first, false)) out_.representation = told.value_or(usual(shape));
            add_stored(key, shape, read_details(file, key, path).label);
        }
    }

    /// Positions have their coordinates on the last axis, motions of the public layout their frames. (3 P, joints, 3) may be three frames of
    /// those, or 3 P frames of positions: the first person's limbs tell.
    bool holds_positions(const hdf5::Reader& file, const std::string& key, const hdf5::Shape& shape) const {
        if (!how_.axes.empty() || shape.size() != 3) return true;
        if (!fits_positions(shape)) return false;
        return !fits_stored(shape) || topology().joints() == 1 || !has_unit_limbs(first_person(file, key));
    }

    bool fits_positions(const hdf5::Shape& shape) const {
        return shape.size() == 3 && shape[0] > 0 && shape[1] == topology().joints() && shape[2] == 3;
    }
    bool fits_stored(const hdf5::Shape& shape) const {
        if (shape.size() != 3 || shape[0] == 0 || shape[2] == 0) return false;
        const auto representation = usual(shape);
        return shape[0] % representation.numbers() == 0 && shape[1] == representation.nodes(topology());
    }

    /// Of an array (3 P, joints, 3), taken for three frames of limbs.
    Motion first_person(const hdf5::Reader& file, const std::string& key) const {
        const auto joints = topology().joints();
        const auto rows = file.read_rows(key, 0, 3);
        Motion motion{key, 3, 1, static_cast<std::uint32_t>(joints), 3, {}};
        for (std::size_t t = 0; t < 3; ++t)
            for (std::size_t k = 0; k < joints; ++k)
                for (std::size_t d = 0; d < 3; ++d) motion.values.push_back(rows[(d * joints + k) * 3 + t]);
        return motion;
    }

    /// Of motions that do not tell it: one more node than joints is that of the translation.
    Representation usual(const hdf5::Shape& shape) const {
        const bool rotations = shape.size() == 3 && shape[1] == topology().joints() + 1 && shape[0] % 6 == 0;
        return rotations ? Representation::rot6d : Representation::limb;
    }

    void add_stored(const std::string& key, const hdf5::Shape& shape, std::optional<std::uint32_t> label) {
        const auto numbers = out_.representation.numbers(), nodes = out_.representation.nodes(topology());
        if (shape.size() != 3 || shape[0] == 0 || shape[0] % numbers != 0 || shape[1] != nodes ||
            shape[2] == 0) {
            out_.faults.emplace_back(
                key, fmt::format("({}) is no motion of {} ({} * persons, {}, frames); see --topology",
                                 fmt::join(shape, ", "), out_.representation.name(), numbers, nodes));
            return;
        }
        std::vector<std::int64_t> labels;
        if (label) labels.push_back(*label);
        out_.motions.push_back(
            {key, 1, false, static_cast<std::uint32_t>(shape[0] / numbers), true, std::move(labels)});
    }

    const RawText& raw_;
    const ArrayReading& how_;
    MotionFile out_;
};

void take_from_npz(const RawText& raw, const MotionFile& file, const Topology& topology,
                   const std::string& axes, const MotionTaker& taker) {
    std::unordered_map<std::string_view, const FoundMotion*> by_key;
    for (const auto& motion : file.motions) by_key.emplace(motion.key, &motion);
    const auto all =
        file.motions.size() == 1 ? by_key.find("") : by_key.end();  // of a file that holds no other
    read_npz(raw.text, {}, [&](const std::string& name, const NumpyArray& array) {
        if (telling.contains(name)) return;
        const auto found = all != by_key.end() ? all : by_key.find(name);
        if (found != by_key.end()) taker.array(*found->second, JointArray(array, topology.joints(), axes));
    });
}

void take_from_hdf5(const RawText& raw, const MotionFile& file, const Topology& topology,
                    const std::string& axes, const MotionTaker& taker) {
    const std::string path(raw.path);
    std::optional<MotionsFile> stored;
    std::optional<hdf5::Reader> arrays;
    for (const auto& motion : file.motions) {
        if (motion.stored) {
            if (!stored) stored.emplace(path, file.representation);
            taker.stored(motion, *stored);
            continue;
        }
        if (!arrays) arrays.emplace(path);
        const auto shape = arrays->shape(motion.key);
        const auto values = arrays->read<double>(motion.key);
        NumpyArray array;
        array.size = sizeof(double);
        array.shape.assign(shape.begin(), shape.end());
        array.values = {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)};
        taker.array(motion, JointArray(array, topology.joints(), axes));
    }
}

}  // namespace

MotionFile look_into(const RawText& raw, const ArrayReading& how) {
    return Look(raw, how).take();
}

void take_motions(const RawText& raw, const MotionFile& file, const Topology& topology,
                  const std::string& axes, const MotionTaker& taker) {
    switch (kind_of(raw.path)) {
        case Kind::npy: {
            const auto array = read_npy(raw.text);
            return taker.array(file.motions[0], JointArray(array, topology.joints(), axes));
        }
        case Kind::npz:
            return take_from_npz(raw, file, topology, axes, taker);
        case Kind::csv: {
            const auto motion = read_csv_motion(raw.text, topology.names);
            const auto array = array_of(motion);
            return taker.array(file.motions[0], JointArray(array, topology.joints(), "tpkc"));
        }
        case Kind::hdf5:
            return take_from_hdf5(raw, file, topology, axes, taker);
    }
}

}  // namespace actformer::ingest
