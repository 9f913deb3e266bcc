#include "ingest/dataset/subjects.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::ingest {
namespace {

std::vector<float> mean_bone_lengths(const Dataset& dataset) {
    const auto clips = dataset.clips().size(), looks = std::min<std::size_t>(clips, 200);
    if (looks == 0) throw Error("{} has no clips to take limb lengths from", dataset.folder().string());
    std::vector<double> sums(dataset.header().persons * dataset.header().topology.joints(), 0);
    for (std::size_t i = 0; i < looks; ++i) {
        const auto lengths = dataset.bone_length(i * clips / looks);
        for (std::size_t at = 0; at < sums.size(); ++at) sums[at] += lengths[at];
    }
    std::vector<float> mean;
    for (const auto sum : sums) mean.push_back(static_cast<float>(sum / static_cast<double>(looks)));
    return mean;
}

/// Whether what is there fits together.
bool fits(const Subjects& subjects) {
    const auto joints = subjects.topology.joints();
    const auto finite = [](float x) { return std::isfinite(x); };
    const auto sound = [](float length) { return std::isfinite(length) && length >= 0; };
    const bool rotations = subjects.representation == Representation::rot6d;
    return subjects.topology.names.size() == joints && subjects.persons >= 1 &&
           (subjects.bone_length.empty() || subjects.bone_length.size() == subjects.persons * joints) &&
           subjects.rest.size() == (rotations ? joints * 3 : 0) &&
           std::ranges::all_of(subjects.bone_length, sound) && std::ranges::all_of(subjects.rest, finite) &&
           std::isfinite(subjects.fps) && subjects.fps > 0;
}

/// The first of these names that is an attribute of the file; files of version 0.1 have the second.
std::string either(const hdf5::Reader& file, const char* name, const char* older) {
    return file.has_attribute(name) || !file.has_attribute(older) ? name : older;
}

std::vector<std::string> texts(const hdf5::Reader& file, const std::string& name) {
    return file.has_attribute(name) ? file.attribute_texts(name) : std::vector<std::string>{};
}

std::vector<float> floats(const hdf5::Reader& file, const std::string& name) {
    return file.has_attribute(name) ? file.attribute_floats(name) : std::vector<float>{};
}

void check_fit(const std::vector<std::string>& names, const char* what) {
    if (const auto bytes = hdf5::packed_size(names); bytes > hdf5::largest_attribute)
        throw Error(
            "{} {}, each stored at the length of the longest name, would take {} bytes in weights and "
            "motions "
            "files, which hold {}: give fewer or shorter names",
            names.size(), what, bytes, hdf5::largest_attribute);
}

Topology read_topology(const hdf5::Reader& file) {
    const auto parents = file.attribute_numbers("parents");
    Topology topology{texts(file, either(file, "names", "joints")), {parents.begin(), parents.end()}};
    if (topology.names.empty())
        for (std::size_t j = 0; j < parents.size(); ++j) topology.names.push_back(fmt::format("joint {}", j));
    return topology;
}

}  // namespace

Subjects subjects_of(const Dataset& dataset) {
    const auto& header = dataset.header();
    return {{header.representation, header.topology, mean_bone_lengths(dataset), header.rest},
            header.persons,
            header.classes,
            header.fps};
}

void write_subjects(hdf5::Writer& file, const Subjects& subjects) {
    file.attribute("representation", subjects.representation.name());
    file.attribute("parents", std::vector<std::int64_t>(subjects.topology.parents.begin(),
                                                        subjects.topology.parents.end()));
    file.attribute("names", subjects.topology.names);
    file.attribute("persons", std::int64_t{subjects.persons});
    if (!subjects.bone_length.empty()) file.attribute("bone_length", subjects.bone_length);
    if (!subjects.rest.empty()) file.attribute("rest", subjects.rest);
    if (!subjects.classes.empty()) file.attribute("classes", subjects.classes);
    file.attribute("fps", std::vector<float>{static_cast<float>(subjects.fps)});
}

void check_names_fit(const DatasetHeader& header) {
    check_fit(header.classes, "classes");
    check_fit(header.topology.names, "joints");
}

std::optional<Representation> read_representation(const hdf5::Reader& file, const std::string& where) {
    if (!file.has_attribute("representation")) return std::nullopt;
    const auto names = file.attribute_texts("representation");
    return Representation::named(names.size() == 1 ? names[0] : "", where);
}

std::optional<Subjects> read_subjects(const hdf5::Reader& file, const std::string& where) {
    if (!file.has_attribute("parents")) return std::nullopt;
    Subjects subjects;
    subjects.representation = read_representation(file, where).value_or(Representation::limb);
    subjects.topology = read_topology(file);
    subjects.bone_length = floats(file, "bone_length");
    subjects.rest = floats(file, "rest");
    subjects.classes = texts(file, either(file, "classes", "class_names"));
    if (file.has_attribute("persons")) {
        const auto persons = file.attribute_numbers("persons");
        subjects.persons = persons.size() == 1 && persons[0] > 0 ? static_cast<std::uint32_t>(persons[0]) : 0;
    } else if (!subjects.bone_length.empty() && subjects.topology.joints() > 0) {
        subjects.persons =
            static_cast<std::uint32_t>(subjects.bone_length.size() / subjects.topology.joints());
    }
    if (file.has_attribute("fps")) {
        const auto fps = file.attribute_floats("fps");
        subjects.fps = fps.size() == 1 ? static_cast<double>(fps[0]) : 0;
    }
    if (!fits(subjects))
        throw Error(
            "{}: its attributes names, parents, persons, bone_length, rest and fps contradict one another: "
            "damaged",
            where);
    subjects.topology.check(where);
    return subjects;
}

}  // namespace actformer::ingest
