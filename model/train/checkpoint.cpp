#include "model/train/checkpoint.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <map>
#include <numeric>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"

namespace actformer::model {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
constexpr std::string_view kind = "actformer checkpoint ", heading = "actformer checkpoint 2\n";
static_assert(std::endian::native == std::endian::little, "checkpoints hold little-endian numbers");

/// Finished checkpoints, the newest first.
std::vector<fs::path> checkpoints_in(const fs::path& folder) {
    constexpr std::string_view prefix = "checkpoint-";
    std::map<std::uint64_t, fs::path> by_number;
    if (!fs::is_directory(folder)) return {};
    for (const auto& entry : fs::directory_iterator(folder)) {
        const auto name = entry.path().filename().string();
        if (!name.starts_with(prefix)) continue;
        std::uint64_t number = 0;
        const auto* end = name.data() + name.size();
        if (std::from_chars(name.data() + prefix.size(), end, number).ptr == end)
            by_number[number] = entry.path();
    }
    std::vector<fs::path> files;
    for (auto& [number, path] : by_number) files.insert(files.begin(), std::move(path));
    return files;
}

/// The text up to the next line end, which is taken off `bytes`; none where there is no line end.
std::optional<std::string_view> take_line(std::string_view& bytes) {
    const auto end = bytes.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const auto line = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return line;
}

std::optional<Array> take_array(const Json& json, std::string_view& bytes) {
    Array array{json.at("name"), json.at("shape"), {}};
    const auto count = static_cast<std::size_t>(
        std::accumulate(array.shape.begin(), array.shape.end(), std::int64_t{1}, std::multiplies<>()));
    const auto take = [&]<typename T>(std::vector<T>& values) {
        const auto size = count * sizeof(T);
        if (size > bytes.size()) return false;
        values.resize(count);
        std::memcpy(values.data(), bytes.data(), size);
        bytes.remove_prefix(size);
        return true;
    };
    if (json.value("type", "float32") == "float64") array.values = std::vector<double>();
    if (!std::visit(take, array.values)) return std::nullopt;
    return array;
}

std::string read_whole(const fs::path& path) {
    std::string bytes;
    read_in_pieces(path, [&](std::string_view piece) { bytes += piece; });
    return bytes;
}

}  // namespace

std::string to_bytes(const Checkpoint& checkpoint) {
    auto arrays = Json::array();
    for (const auto& array : checkpoint.arrays) {
        arrays.push_back({{"name", array.name}, {"shape", array.shape}});
        if (std::holds_alternative<std::vector<double>>(array.values)) arrays.back()["type"] = "float64";
    }
    auto body =
        Json{{"done", checkpoint.done}, {"state", checkpoint.state}, {"arrays", arrays}}.dump() + "\n";
    const auto append = [&]<typename T>(const std::vector<T>& values) {
        body.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    };
    for (const auto& array : checkpoint.arrays) std::visit(append, array.values);
    return std::string(heading) + checksum(body) + "\n" + body;
}

std::optional<Checkpoint> checkpoint_from(std::string_view bytes) {
    if (!bytes.starts_with(heading)) return std::nullopt;
    bytes.remove_prefix(heading.size());
    const auto wanted = take_line(bytes);
    if (!wanted || checksum(bytes) != *wanted) return std::nullopt;
    const auto line = take_line(bytes);
    if (!line) return std::nullopt;
    const auto json = Json::parse(*line);  // whole, as the checksum says
    Checkpoint checkpoint{json.at("done"), json.at("state"), {}};
    for (const auto& one : json.at("arrays")) {
        auto array = take_array(one, bytes);
        if (!array) return std::nullopt;
        checkpoint.arrays.push_back(std::move(*array));
    }
    return checkpoint;
}

void save_checkpoint(const fs::path& folder, const Checkpoint& checkpoint) {
    write_whole(folder / fmt::format("checkpoint-{:05}", checkpoint.done), to_bytes(checkpoint));
    const auto files = checkpoints_in(folder);
    for (std::size_t i = 2; i < files.size(); ++i) fs::remove(files[i]);
}

std::optional<Checkpoint> newest_checkpoint(const fs::path& folder, const std::string& model,
                                            const std::function<void(const std::string&)>& note) {
    const auto files = checkpoints_in(folder);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto bytes = read_whole(files[i]);
        if (bytes.starts_with(kind) && bytes.size() > heading.size() && !bytes.starts_with(heading))
            throw Error(
                "{}: written by another version of actformer; go on with that one, or choose another -o",
                files[i].string());
        if (auto checkpoint = checkpoint_from(bytes)) {
            if (const auto whose = checkpoint->state.value("model", "unknown"); whose != model)
                throw Error("{}: a checkpoint of a {}, not of a {}; choose another -o", files[i].string(),
                            whose, model);
            return checkpoint;
        }
        note(fmt::format("{}: cut short or damaged; {}", files[i].string(),
                         i + 1 < files.size() ? "going back to the one before" : "starting anew"));
        fs::rename(files[i], files[i].string() + ".damaged");
    }
    return std::nullopt;
}

}  // namespace actformer::model
