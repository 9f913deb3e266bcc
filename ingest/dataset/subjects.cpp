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

bool drawable(const Subjects& subjects) {
    const auto sound = [](float length) { return std::isfinite(length) && length >= 0; };
    return subjects.topology.names.size() == subjects.topology.joints() && subjects.persons >= 1 &&
           subjects.bone_length.size() == subjects.persons * subjects.topology.joints() &&
           std::ranges::all_of(subjects.bone_length, sound) && std::isfinite(subjects.fps) &&
           subjects.fps > 0;
}

}  // namespace

Subjects subjects_of(const Dataset& dataset) {
    const auto& header = dataset.header();
    return {header.topology, header.persons, mean_bone_lengths(dataset), header.classes, header.fps};
}

void write_subjects(hdf5::Writer& file, const Subjects& subjects) {
    file.attribute("parents", std::vector<std::int64_t>(subjects.topology.parents.begin(),
                                                        subjects.topology.parents.end()));
    file.attribute("joints", subjects.topology.names);
    file.attribute("persons", std::int64_t{subjects.persons});
    file.attribute("bone_length", subjects.bone_length);
    file.attribute("class_names", subjects.classes);
    file.attribute("fps", std::vector<float>{static_cast<float>(subjects.fps)});
}

std::optional<Subjects> read_subjects(const hdf5::Reader& file, const std::string& where) {
    if (!file.has_attribute("bone_length")) return std::nullopt;
    Subjects subjects;
    const auto parents = file.attribute_numbers("parents"), persons = file.attribute_numbers("persons");
    const auto fps = file.attribute_floats("fps");
    subjects.topology = {file.attribute_texts("joints"), {parents.begin(), parents.end()}};
    subjects.bone_length = file.attribute_floats("bone_length");
    subjects.classes = file.attribute_texts("class_names");
    subjects.persons = persons.size() == 1 ? static_cast<std::uint32_t>(persons[0]) : 0;
    subjects.fps = fps.size() == 1 ? static_cast<double>(fps[0]) : 0;
    if (!drawable(subjects))
        throw Error(
            "{}: its attributes joints, parents, persons, bone_length and fps contradict one another: "
            "damaged",
            where);
    subjects.topology.check(where);
    return subjects;
}

}  // namespace actformer::ingest
