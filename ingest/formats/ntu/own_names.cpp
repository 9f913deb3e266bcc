#include "ingest/formats/ntu/own_names.hpp"

#include "base/error.hpp"

namespace actformer::ingest {

OwnNames::OwnNames(OwnNamesOptions options)
    : options_(std::move(options)), names_(options_.pattern, options_.labels) {
    if (names_.groups_files())
        throw Error(
            "{{person}} makes several files one clip, but a .skeleton file shows all its persons; call the "
            "field {{performer}}, or pass over it with {{*}}");
    if (options_.persons > 100)
        throw Error("{} persons a clip are too many; give 1 to 100", options_.persons);
    check_fields(options_.splits, names_.fields());
}

void OwnNames::note(const RawText& raw) {
    const auto clips = names_.clips_of(raw);
    const std::lock_guard lock(noting_);
    names_.note(raw);
    if (const auto* all = std::get_if<std::vector<NamedClip>>(&clips))
        for (const auto& clip : *all) {
            actions_.insert(clip.action);
            fields_of_clips_.insert(clip.fields);
        }
}

DatasetHeader OwnNames::settle() {
    names_.settle();
    DatasetHeader header;
    header.name = options_.dataset;
    header.topology = ntu25();
    header.persons = persons();
    header.classes = {actions_.begin(), actions_.end()};
    header.fields = names_.fields();
    header.splits = options_.splits;
    return header;
}

std::vector<std::string> OwnNames::remarks() const {
    auto lines = names_.remarks({actions_.begin(), actions_.end()});
    for (auto& line : empty_splits(options_.splits, names_.fields(), fields_of_clips_))
        lines.push_back(std::move(line));
    return lines;
}

std::string OwnNames::settings() const {
    return fmt::format("dataset '{}', {}, {} persons a clip, classes {}, splits{}", options_.dataset,
                       names_.settings(), persons(), fmt::join(actions_, ","), to_text(options_.splits));
}

}  // namespace actformer::ingest
