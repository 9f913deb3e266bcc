#include "model/train/checkpoint.hpp"

#include <charconv>
#include <fstream>
#include <iterator>
#include <map>

#include "base/checksum/own_checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "base/text/json.hpp"
#include "base/text/loose_json.hpp"

namespace actformer::model {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view prefix = "checkpoint-", extension = ".h5";
constexpr const char *progress = "progress", *steps_done = "step";
constexpr std::string_view before_hdf5 = "actformer checkpoint ";  // how files of earlier versions begin

/// A file's step, by its name; none where it is no finished checkpoint, of this version or an earlier one.
std::optional<std::uint64_t> step_of(std::string name) {
    if (!name.starts_with(prefix)) return std::nullopt;
    if (name.ends_with(extension)) name.resize(name.size() - extension.size());
    std::uint64_t step = 0;
    const auto* end = name.data() + name.size();
    if (std::from_chars(name.data() + prefix.size(), end, step).ptr != end) return std::nullopt;
    return step;
}

/// Finished checkpoints, the newest first. Folders and links to nothing that have such a name are left out.
std::vector<fs::path> checkpoints_in(const fs::path& folder) {
    std::map<std::uint64_t, fs::path, std::greater<>> by_step;
    try {
        if (!fs::is_directory(folder)) return {};
        std::error_code ignored;
        for (const auto& entry : fs::directory_iterator(folder))
            if (const auto step = step_of(entry.path().filename().string());
                step && entry.is_regular_file(ignored))
                by_step[*step] = entry.path();
    } catch (const fs::filesystem_error& e) {
        throw Error("{}: cannot be listed: {}", folder.string(), e.code().message());
    }
    std::vector<fs::path> files;
    for (auto& [step, path] : by_step) files.push_back(std::move(path));
    return files;
}

/// Behind a new one: all but it and the one before. What cannot be removed stays.
void remove_older_checkpoints(const fs::path& folder) {
    try {
        const auto files = checkpoints_in(folder);
        std::error_code ignored;
        for (std::size_t i = 2; i < files.size(); ++i) fs::remove(files[i], ignored);
    } catch (const Error&) {  // that the folder cannot be listed is said when it is read
    }
}

/// As NAME.damaged.
void set_aside(const fs::path& damaged) {
    std::error_code error;
    fs::rename(damaged, damaged.string() + ".damaged", error);
    if (error)
        throw Error("{}: damaged, and cannot be renamed: {}; remove it", damaged.string(), error.message());
}

bool is_of_an_earlier_version(const fs::path& path) {
    std::string beginning(before_hdf5.size(), '\0');
    return std::ifstream(path, std::ios::binary).read(beginning.data(), std::ssize(beginning)) &&
           beginning == before_hdf5;
}

std::size_t bytes_of(const std::vector<Array>& arrays) {
    std::size_t bytes = 0;
    for (const auto& array : arrays)
        bytes +=
            std::visit([](const auto& values) { return values.size() * sizeof(values[0]); }, array.values);
    return bytes;
}

}  // namespace

fs::path checkpoint_path(const fs::path& folder, std::uint64_t step) {
    return folder / fmt::format("{}{:05}{}", prefix, step, extension);
}

void save_checkpoint(const fs::path& folder, const Checkpoint& checkpoint) {
    hdf5::Writer file(bytes_of(checkpoint.arrays));
    for (const auto& array : checkpoint.arrays)
        std::visit(
            [&]<typename T>(const std::vector<T>& values) {
                file.write<T>(array.name, {array.shape.begin(), array.shape.end()}, values);
            },
            array.values);
    file.write_strings(progress, {checkpoint.state.dump()});
    file.attribute(steps_done, static_cast<std::int64_t>(checkpoint.step));
    file.attribute("program", std::string("actformer " ACTFORMER_VERSION));
    write_whole(checkpoint_path(folder, checkpoint.step), file.checked_image());
    remove_older_checkpoints(folder);
}

std::optional<Checkpoint> read_checkpoint(const fs::path& path) {
    if (own_checksum_of_file(path) != OwnChecksum::right) return std::nullopt;
    const hdf5::Reader file(path);
    if (!file.has(progress) || !file.has_attribute(steps_done)) return std::nullopt;
    const auto steps = file.attribute_numbers(steps_done);
    const auto states = file.read_strings(progress);
    if (steps.size() != 1 || steps[0] < 0 || states.size() != 1) return std::nullopt;
    Checkpoint checkpoint;
    checkpoint.step = static_cast<std::uint64_t>(steps[0]);
    checkpoint.state = json_or_discarded<Json>(states[0]);
    if (!checkpoint.state.is_object()) return std::nullopt;
    const auto names = file.names();
    file.expect_room_for(names);
    for (const auto& name : names) {
        if (name == progress) continue;
        const auto shape = file.shape(name);
        Array array{name, {shape.begin(), shape.end()}, {}};
        if (file.holds_doubles(name))
            array.values = file.read<double>(name);
        else
            array.values = file.read<float>(name);
        checkpoint.arrays.push_back(std::move(array));
    }
    return checkpoint;
}

std::optional<Checkpoint> newest_checkpoint(const fs::path& folder, const std::string& model,
                                            const std::function<void(const std::string&)>& note) {
    const auto files = checkpoints_in(folder);
    fs::path earlier;  // the newest of an earlier version
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (files[i].extension() != extension && is_of_an_earlier_version(files[i])) {
            if (earlier.empty()) earlier = files[i];
            continue;
        }
        if (auto checkpoint = read_checkpoint(files[i])) {
            if (const auto whose = loose::text(checkpoint->state, "model"); whose != model)
                throw Error("{}: a checkpoint of {}, not of {}; choose another -o", files[i].string(),
                            whose.empty() ? "no known model" : whose, model);
            if (!earlier.empty())
                note(fmt::format("{}: of another version; going back to {}", earlier.string(),
                                 files[i].string()));
            return checkpoint;
        }
        note(fmt::format("{}: cut short or damaged; {}", files[i].string(),
                         i + 1 < files.size() ? "going back to the one before" : "starting anew"));
        set_aside(files[i]);
    }
    if (!earlier.empty())
        throw Error(
            "{}: written by an earlier version of actformer; go on with that one, or choose another -o",
            earlier.string());
    return std::nullopt;
}

}  // namespace actformer::model
