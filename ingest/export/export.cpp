#include "ingest/export/export.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/printable.hpp"
#include "base/text/suggestion.hpp"
#include "ingest/dataset/own_kind.hpp"
#include "ingest/export/export_format.hpp"
#include "ingest/export/fit_name.hpp"
#include "ingest/export/foreign.hpp"
#include "ingest/export/skeletons.hpp"
#include "ingest/formats/name_pattern.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

/// As in ".bvh" where `before` is a dot.
std::vector<std::string> format_names(std::string_view before) {
    std::vector<std::string> names;
    for (const auto& format : export_formats()) names.push_back(fmt::format("{}{}", before, format.name));
    return names;
}

/// What is written, and whether into a folder.
struct Target {
    const ExportFormat* format = nullptr;
    bool folder = false;
};

Target target_of(const ExportRequest& request) {
    std::error_code ignored;
    const auto out = request.out.string();
    const auto ending = request.out.extension().string();
    const bool is_folder = out.ends_with('/') || fs::is_directory(request.out, ignored);
    const auto* by_ending = ending.empty() ? nullptr : export_format(std::string_view(ending).substr(1));
    if (request.format.empty()) {
        if (is_folder)
            throw Error("{}: a folder takes a file a clip: say of what kind with --format, one of {}", out,
                        fmt::join(format_names(""), ", "));
        if (!by_ending)
            throw Error(
                "{}: ends in none of {}; or give --format to make a folder of it with a file a clip{}", out,
                fmt::join(format_names("."), ", "),
                ending.empty() ? "" : suggestion(ending, format_names(".")));
        return {by_ending, false};
    }
    const auto* named = export_format(request.format);
    if (!named)
        throw Error("--format {}: there is {}{}", in_quotes(request.format),
                    fmt::join(format_names(""), ", "), suggestion(request.format, format_names("")));
    if (is_folder || !by_ending) return {named, true};
    if (by_ending != named)
        throw Error("{}: ends in {}, but --format says {}; leave one of them out", out, ending,
                    request.format);
    return {named, false};
}

/// Whether `pattern` reads the clips' classes out of their files' names: what they are called, or a number for each.
bool tells_classes(const NamePattern& pattern, const std::vector<std::string>& files,
                   const std::vector<ClipEntry>& clips, const std::vector<std::string>& classes) {
    std::map<std::string, std::uint32_t> class_of_number;
    std::set<std::uint32_t> numbered;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto label = clips[i].label;
        const auto values = pattern.match(files[i]);
        if (!values || !label || *label >= classes.size()) return false;
        const auto& action = (*values)[pattern.action()];
        if (action == fit_name(classes[*label], NameFor::file)) continue;
        if (action.size() < 3 || action.find_first_not_of("0123456789") != std::string::npos) return false;
        if (class_of_number.emplace(action, *label).first->second != *label) return false;
        numbered.insert(*label);
    }
    return numbered.size() == class_of_number.size();
}

/// How `ingest bvh` reads a folder of these files.
std::string how_to_read_back(const std::vector<std::string>& files, const std::vector<ClipEntry>& clips,
                             const Subjects& subjects) {
    const char* persons = subjects.persons > 1 ? "_p{person}" : "";
    for (const char* pattern : {"{action}_{index}", "A{action}_{index}", "{*}A{action}"})
        if (tells_classes(NamePattern(pattern), files, clips, subjects.classes))
            return fmt::format(
                "files are named after their clips: `ingest bvh --name '{}{}'` reads them back", pattern,
                persons);
    return "files are named after their clips, which do not tell the classes: `ingest bvh --labels` reads "
           "them back with a table of them";
}

/// Whether `path` is `input` or one of its shards, through links too.
bool is_read(const fs::path& path, const fs::path& input) {
    std::error_code unread;
    if (fs::equivalent(path, input, unread)) return true;
    return fs::equivalent(fs::canonical(path, unread).parent_path(), input, unread) &&
           own_kind(path) == own::shard;
}

class Export {
  public:
    Export(const ExportRequest& request, const ClipSource& source, Target target, std::size_t first)
        : request_(request),
          source_(source),
          target_(target),
          context_{source.subjects(), {}, source.fingerprint()} {
        if (request.selection.person > 0) {
            context_.subjects.persons = 1;
            keep_lengths_of(request.selection.person);
        }
        if (!request.body.empty()) take_body();
        if (target.format->skeletons && source.subjects().representation != Representation::rot6d)
            context_.pose = rest_pose(source.read(first));
        context_.force = request.force;
        context_.public_names_note = source.public_names_note();
        summary_.format = target.format->name;
        summary_.representation = source.subjects().representation.name();
    }

    ExportSummary run(const std::vector<std::size_t>& picks,
                      const std::function<void(std::size_t, std::size_t)>& progress) {
        if (target_.folder)
            into_folder(picks, progress);
        else
            into_file(picks, progress);
        return std::move(summary_);
    }

  private:
    void take_body() {
        const auto& subjects = source_.subjects();
        if (!target_.format->bodies)
            throw Error("--body {}: a .{} holds no skin; leave it out, or export a .glb",
                        request_.body.string(), target_.format->name);
        check_takes_body(subjects, source_.path().string());
        context_.body = read_smpl_body(request_.body);
    }

    void into_file(const std::vector<std::size_t>& picks,
                   const std::function<void(std::size_t, std::size_t)>& progress) {
        if (picks.size() > 1 && !target_.format->many_clips)
            throw Error(
                "{}: a .{} holds one clip and {} are chosen; choose one with --clip, or make a folder of "
                "them with --format {}",
                request_.out.string(), target_.format->name, picks.size(), target_.format->name);
        check_replaces(request_.out);
        const auto file = target_.format->open(request_.out, context_);
        for (std::size_t i = 0; i < picks.size(); ++i) {
            add(*file, picks[i]);
            if (progress) progress(i + 1, picks.size());
        }
        finish(*file);
    }

    void into_folder(const std::vector<std::size_t>& picks,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
        refuse_other_folder(request_.out, "exported motions");
        std::vector<std::string> clips;
        for (const auto i : picks) clips.push_back(source_.clips()[i].name);
        const auto names = fit_names(clips, NameFor::file);
        note(names_changed(clips, names, "file name"));
        std::vector<fs::path> paths;
        for (const auto& name : names)
            check_replaces(
                paths.emplace_back(request_.out / fmt::format("{}.{}", name, target_.format->name)));
        make_folders(request_.out);
        context_.sync = Sync::later;  // all at once, below
        for (std::size_t i = 0; i < picks.size(); ++i) {
            const auto file = target_.format->open(paths[i], context_);
            add(*file, picks[i]);
            finish(*file);
            if (progress) progress(i + 1, picks.size());
        }
        sync_all(request_.out);
        if (target_.format->name == "bvh") {
            std::vector<ClipEntry> chosen;
            for (const auto i : picks) chosen.push_back(source_.clips()[i]);
            note(how_to_read_back(names, chosen, context_.subjects));
        }
    }

    void check_replaces(const fs::path& path) const {
        if (!request_.force) refuse_foreign(path);
        for (const auto& input : {source_.path(), request_.bones, request_.body})
            if (is_read(path, input))
                throw Error("{}: is an input of this export; choose another -o", path.string());
    }

    void add(ExportFile& file, std::size_t clip) {
        auto read = with_person(source_.read(clip), request_.selection.person, source_.path().string());
        if (context_.body) read.body.rest = context_.body->rest().rest();
        file.add(read);
        ++summary_.clips;
        summary_.frames += read.motion.frames;
    }

    void finish(ExportFile& file) {
        for (auto& path : file.finish()) summary_.files.push_back(std::move(path));
        note(file.note());
    }

    void note(const std::string& text) {
        if (!text.empty() && std::ranges::count(summary_.notes, text) == 0) summary_.notes.push_back(text);
    }

    void keep_lengths_of(std::size_t person) {
        auto& lengths = context_.subjects.bone_length;
        const auto joints = context_.subjects.topology.joints();
        if (lengths.size() < person * joints) return;
        lengths = {lengths.begin() + static_cast<std::ptrdiff_t>((person - 1) * joints),
                   lengths.begin() + static_cast<std::ptrdiff_t>(person * joints)};
    }

    const ExportRequest& request_;
    const ClipSource& source_;
    Target target_;
    ExportContext context_;
    ExportSummary summary_;
};

}  // namespace

ExportSummary export_clips(const ExportRequest& request,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
    const auto target = target_of(request);
    const auto source = open_clips(request.input, request.bones);
    const auto picks = selected(*source, request.selection);
    return Export(request, *source, target, picks[0]).run(picks, progress);
}

}  // namespace actformer::ingest
