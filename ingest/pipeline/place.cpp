#include "ingest/pipeline/place.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/work_folder.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

constexpr const char* inside = ".partial";
// In the workplace: names of its data, each behind a zero byte, that may have been moved up.
constexpr const char* delivering = "delivering";
constexpr const char* record = "ingest.json";  // what tells a finished folder, and so is moved last

/// What is in OUT apart from the workplace, the record last.
std::vector<fs::path> entries_of(const fs::path& out) {
    std::vector<fs::path> all;
    for (const auto& entry : fs::directory_iterator(out))
        if (const auto name = entry.path().filename(); name != inside && name != "lost+found")
            all.push_back(name);
    std::ranges::sort(all, {}, [](const fs::path& name) { return std::pair(name == record, name); });
    return all;
}

void move_up_or_back(const std::vector<fs::path>& names, const fs::path& from, const fs::path& to) {
    for (const auto& name : names) {
        std::error_code error;
        fs::rename(from / name, to / name, error);
        if (error) throw Error("{}: cannot be put in place: {}", (to / name).string(), error.message());
    }
}

/// Whether an ingest writes such a file, below its workplace: lists of what is done, and datasets in `data`.
bool is_own_file(const fs::path& below) {
    const auto called_as = [](const fs::path& name, std::initializer_list<const char*> own) {
        return std::ranges::any_of(own, [&](const char* file) { return is_called(name, file); });
    };
    const auto name = below.filename();
    if (!below.has_parent_path()) return called_as(name, {"lock", "journal", "announced", delivering});
    return *below.begin() == "data" &&
           (name.native().starts_with("shard-") || called_as(name, {"dataset.json", "rejected.csv", record}));
}

}  // namespace

void expect_own_workplace(const fs::path& workplace) {
    expect_own_folder(workplace, is_own_file);
}

void remove_workplace(const fs::path& workplace) {
    remove_own_folder(workplace, is_own_file);
}

fs::path workplace_of(const fs::path& out) {
    std::error_code ignored;
    return fs::is_directory(out, ignored) ? out / inside : fs::path(without_links(out).string() + inside);
}

bool is_taken(const fs::path& out) {
    std::error_code ignored;
    if (!fs::is_directory(out, ignored)) return fs::exists(out, ignored);
    return !entries_of(out).empty() && !fs::exists(out / inside / delivering);
}

void put_in_place(const fs::path& data, const fs::path& workplace, const fs::path& out) {
    sync_folder(data);
    if (workplace.filename() == inside) {
        const auto names = entries_of(data);
        std::string text;
        for (const auto& name : names) text += '\0' + name.string();
        write_whole(workplace / delivering, text);
        move_up_or_back(names, data, out);
        sync_folder(out);
        fs::remove(workplace / delivering);  // from here on it is finished
        return;
    }
    const auto to = without_links(out);
    std::error_code error;
    fs::rename(data, to, error);
    if (error) throw Error("{}: cannot be put in place: {}", out.string(), error.message());
    sync_names(to.has_parent_path() ? to.parent_path() : fs::path("."));
}

void take_back(const fs::path& data, const fs::path& workplace) {
    if (!fs::exists(workplace / delivering)) return;
    make_folders(data);
    std::vector<char> scratch;
    auto text = read_text(workplace / delivering, scratch, std::uint64_t{1} << 20);
    std::vector<fs::path> names;
    while (!text.empty()) {
        text.remove_prefix(1);
        names.emplace_back(text.substr(0, text.find('\0')));
        text.remove_prefix(std::min(text.size(), names.back().native().size()));
    }
    std::erase_if(names, [&](const fs::path& name) { return !fs::exists(workplace.parent_path() / name); });
    move_up_or_back(names, workplace.parent_path(), data);
    fs::remove(workplace / delivering);
}

}  // namespace actformer::ingest
