#include "ingest/pipeline/place.hpp"

#include <algorithm>
#include <optional>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/work_folder.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

constexpr const char* inside = ".partial";
// In the workplace: names of its data that may have been moved up, each behind a zero byte, and their checksum before them.
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

bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(path, ignored));
}

/// Replaces nothing.
void move_up_or_back(const std::vector<fs::path>& names, const fs::path& from, const fs::path& to) {
    for (const auto& name : names) {
        if (is_there(to / name))
            throw Error("{}: cannot be put in place: something is there; move it, or choose another -o",
                        (to / name).string());
        std::error_code error;
        fs::rename(from / name, to / name, error);
        if (error) throw Error("{}: cannot be put in place: {}", (to / name).string(), error.message());
    }
}

std::string list_of(const std::vector<fs::path>& names) {
    std::string text;
    for (const auto& name : names) text += '\0' + name.string();
    return checksum(text) + text;
}

/// Of what lies in OUT itself, and not above or below it.
bool is_plain(const fs::path& name) {
    return !name.empty() && name == name.filename() && name != "." && name != ".." && name != inside;
}

/// None where list_of() did not make it.
std::optional<std::vector<fs::path>> names_in(std::string_view list) {
    auto text = list.substr(std::min(list.find('\0'), list.size()));
    if (list.substr(0, list.size() - text.size()) != checksum(text)) return {};
    std::vector<fs::path> names;
    while (!text.empty()) {
        text.remove_prefix(1);
        names.emplace_back(text.substr(0, text.find('\0')));
        text.remove_prefix(names.back().native().size());
    }
    if (!std::ranges::all_of(names, is_plain)) return {};
    return names;
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

/// Throws Error, with the remedy, where what is called so in OUT is a link, or anything in it was made by others.
void expect_own(const fs::path& out, const fs::path& name) {
    const auto below = "data" / name;
    std::error_code ignored;
    if (fs::is_regular_file(fs::symlink_status(out / name, ignored)) && is_own_file(below)) return;
    expect_own_folder(out / name, [&](const fs::path& file) { return is_own_file(below / file); });
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

std::vector<fs::path> own_folders(const fs::path& out) {
    std::vector<fs::path> all{out};
    for (const auto& work : {workplace_of(out), fs::path(out.string() + inside)}) try {
            expect_own_workplace(work);
            all.push_back(work);
        } catch (const Error&) {  // others made it
        }
    return all;
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
        write_whole(workplace / delivering, list_of(names));
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
    const auto list = workplace / delivering, out = workplace.parent_path();
    if (workplace.filename() != inside || !is_there(list)) return;
    std::vector<char> scratch;
    auto names = names_in(read_text(list, scratch, std::uint64_t{1} << 20));
    if (!names)
        throw Error(
            "{}: damaged: it told what of {} is an ingest's; remove that folder once nothing of yours is "
            "in it, or choose another -o",
            list.string(), out.string());
    std::erase_if(*names, [&](const auto& name) { return !is_there(out / name) || is_there(data / name); });
    for (const auto& name : *names) expect_own(out, name);
    make_folders(data);
    move_up_or_back(*names, out, data);
    fs::remove(list);
}

}  // namespace actformer::ingest
