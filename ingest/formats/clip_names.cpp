#include "ingest/formats/clip_names.hpp"

#include <algorithm>
#include <set>
#include <unordered_set>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "ingest/dataset/dataset.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view person_field = "person";

/// Clips of a file that are called alike but show different actions, as labels of the same span do, have these behind their names.
void call_apart(std::vector<NamedClip>& clips) {
    std::map<std::string, std::set<std::string>> actions;
    for (const auto& clip : clips) actions[clip.name].insert(clip.action);
    for (auto& clip : clips)
        if (actions[clip.name].size() > 1) clip.name += "_" + clip.action;
}

std::size_t parts_of(const std::string& path) {
    return 1 + static_cast<std::size_t>(std::count(path.begin(), path.end(), '/'));
}

}  // namespace

std::string path_for_names(const RawText& raw) {
    const auto inside = without_extension(raw.inside);
    const auto before = raw.path.size() - std::min(raw.inside.size(), raw.path.size());
    const bool in_archive = before > 0 && raw.path[before - 1] == ':';
    if (in_archive) return std::string(inside);
    return std::string(without_extension(fs::absolute(raw.path).lexically_normal().string()));
}

std::string name_of_path(const std::string& path, std::size_t folders) {
    auto begin = path.size();
    for (std::size_t i = 0; i <= folders && begin != 0 && begin != std::string::npos; ++i)
        begin = path.rfind('/', begin - 1);
    auto name = path.substr(begin == std::string::npos ? 0 : begin + 1);
    std::replace(name.begin(), name.end(), '/', '_');
    return printable(name);
}

ClipNames::ClipNames(const std::string& pattern, const fs::path& labels) {
    if (pattern.empty() && labels.empty())
        throw Error(
            "no actions are told; give --name, as in --name '{{action}}_{{index}}' or "
            "'{{action}}/{{index}}', or a table "
            "of labels with --labels");
    if (!labels.empty()) {
        labels_.emplace(labels);
        labels_path_ = labels.string();
        labels_checksum_ = checksum_file(labels);
        fields_ = labels_->fields();
        if (const auto person = std::find(fields_.begin(), fields_.end(), person_field);
            person != fields_.end()) {
            person_ = static_cast<std::size_t>(person - fields_.begin());
            fields_.erase(person);
            groups_ = true;
        }
        used_.resize(labels_->rows().size());
    }
    if (pattern.empty()) return;
    pattern_.emplace(pattern, labels.empty());
    for (std::size_t f = 0; f < pattern_->fields().size(); ++f) {
        const auto& field = pattern_->fields()[f];
        groups_ |= field == person_field;
        if (field == person_field || std::find(fields_.begin(), fields_.end(), field) != fields_.end())
            continue;
        kept_.push_back(f);
        fields_.push_back(field);
    }
    if (fields_.size() > most_fields)
        throw Error("{} fields out of --labels and --name, and a clip has at most {}; leave out some columns",
                    fields_.size(), most_fields);
}

std::string ClipNames::settings() const {
    std::string out;
    if (pattern_) out = fmt::format("names '{}'", printable(pattern_->text()));
    if (labels_) out += fmt::format("{}labels {}", out.empty() ? "" : ", ", labels_checksum_);
    if (folders_ > 0) out += fmt::format(", {} folders in names", folders_);
    return out;
}

std::variant<ClipNames::Known, Rejection> ClipNames::known(const std::string& path) const {
    Known out;
    if (pattern_) {
        const auto values = pattern_->match(path);
        if (!values)
            return Rejection{Rejection::Kind::broken, fmt::format("the name does not fit the pattern '{}'",
                                                                  printable(pattern_->text()))};
        for (const auto f : kept_) out.fields.push_back((*values)[f]);
        const auto& fields = pattern_->fields();
        if (std::find(fields.begin(), fields.end(), person_field) != fields.end())
            for (std::size_t f = 0; f < fields.size(); ++f)
                if (fields[f] != person_field) out.group += (*values)[f] + "\n";
    }
    if (labels_) {
        out.rows = labels_->find(path);
        if (out.rows.empty())
            return Rejection{Rejection::Kind::dropped,
                             fmt::format("no row of {} is for it", printable(labels_path_))};
    }
    return out;
}

void ClipNames::note(std::string path, std::uint64_t index) {
    const auto found = known(path);
    if (!any_noted_ || index < first_index_) {
        first_path_ = path.substr(path.rfind('/') + 1);
        first_index_ = index;
        any_noted_ = true;
    }
    if (std::holds_alternative<Rejection>(found)) return;
    for (const auto row : std::get<Known>(found).rows) used_[row] = true;
    paths_.push_back(std::move(path));
}

void ClipNames::settle() {
    if (paths_.empty() && pattern_ && !labels_)
        throw Error("no file name fits the pattern '{}'; there is {}", printable(pattern_->text()),
                    any_noted_ ? in_quotes(first_path_) : "no file");
    if (paths_.empty())
        throw Error("{}: no row is for any of the files; there is {}", labels_path_,
                    any_noted_ ? in_quotes(first_path_) : "no file");
    std::size_t deepest = 0;
    for (const auto& path : paths_) deepest = std::max(deepest, parts_of(path));
    for (folders_ = 0; folders_ < deepest; ++folders_) {
        std::unordered_set<std::string> names;
        if (std::all_of(paths_.begin(), paths_.end(),
                        [&](const auto& path) { return names.insert(name_of(path)).second; }))
            return;
    }
    folders_ = 0;  // the very same paths, in several archives: the pipeline takes the first of each name
}

std::variant<std::vector<NamedClip>, Rejection> ClipNames::clips_of(const std::string& path) const {
    auto found = known(path);
    if (auto* rejection = std::get_if<Rejection>(&found)) return std::move(*rejection);
    const auto& file = std::get<Known>(found);
    std::vector<NamedClip> out;
    if (!labels_) {
        out.push_back({name_of(path),
                       file.fields[static_cast<std::size_t>(
                           std::find(kept_.begin(), kept_.end(), pattern_->action()) - kept_.begin())],
                       file.fields,
                       {},
                       {}});
        return out;
    }
    for (const auto r : file.rows) {
        const auto& row = labels_->rows()[r];
        NamedClip clip{name_of(path), row.action, row.fields, row.start, row.end};
        if (file.rows.size() > 1)
            clip.name +=
                fmt::format("_{}-{}", row.start.value_or(0), row.end ? fmt::to_string(*row.end) : "end");
        if (person_) clip.fields.erase(clip.fields.begin() + static_cast<std::ptrdiff_t>(*person_));
        clip.fields.insert(clip.fields.end(), file.fields.begin(), file.fields.end());
        out.push_back(std::move(clip));
    }
    call_apart(out);
    return out;
}

std::string ClipNames::group_of(const RawText& raw) const {
    const auto found = known(path_for_names(raw));
    if (std::holds_alternative<Rejection>(found)) return {};
    const auto& file = std::get<Known>(found);
    std::string group = file.group;
    if (group.empty() && person_)
        for (std::size_t f = 0; f < labels_->fields().size(); ++f)
            if (f != *person_) group += labels_->rows()[file.rows[0]].fields[f] + "\n";
    return group;
}

std::string ClipNames::one_class(const std::vector<std::string>& classes) const {
    if (classes.size() != 1) return {};
    const auto found = fmt::format("all clips are of one class, {}", in_quotes(classes[0]));
    if (labels_) return fmt::format("{}, as {} says", found, printable(labels_path_));
    const bool of_folder = pattern_->text().rfind('/') != std::string::npos &&
                           pattern_->text().find("{action}") < pattern_->text().rfind('/');
    return fmt::format("{}, {} of --name {}; where {} the action, give --name '{}'", found,
                       of_folder ? "a folder's name by the {action}" : "by the {action}",
                       in_quotes(pattern_->text()), of_folder ? "the files' own names tell" : "folders tell",
                       of_folder ? "{action}_{index}" : "{action}/{index}");
}

std::vector<std::string> ClipNames::remarks(const std::vector<std::string>& classes) const {
    std::vector<std::string> lines{unused_labels(), one_class(classes)};
    std::erase(lines, std::string());
    return lines;
}

std::string ClipNames::unused_labels() const {
    std::vector<std::string> files;
    for (std::size_t r = 0; r < used_.size(); ++r)
        if (!used_[r]) files.push_back(printable(labels_->rows()[r].file));
    if (files.empty()) return {};
    return fmt::format("{}: {} of {} rows are for files that are not there: {}", printable(labels_path_),
                       files.size(), used_.size(), first_few(files));
}

}  // namespace actformer::ingest
