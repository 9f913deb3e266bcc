#include "ingest/formats/babel/babel_format.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "base/text/counted.hpp"
#include "base/text/first_few.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/babel/amass_file.hpp"
#include "ingest/formats/babel/categories.hpp"
#include "ingest/formats/babel/zoom.hpp"
#include "ingest/formats/frame_span.hpp"

namespace actformer::ingest {
namespace {

bool is_json(const RawText& raw) {
    return raw.ends_in(".json");
}

Rejection dropped(std::string reason) {
    return {Rejection::Kind::dropped, std::move(reason)};
}

/// "label 3 of sequence 12 ('walk')"
std::string place_of(const Sequence& sequence, std::size_t label) {
    return fmt::format("label {} of sequence {} ({})", label, printable(sequence.id),
                       in_quotes(sequence.segments[label].text));
}

/// Frames that a label spans: the public tools' whole numbers of `rate` frames a second.
FrameSpan span_of(const Segment& segment, std::uint32_t frames, double rate) {
    const auto frame = [&](const std::optional<double>& seconds) {
        return seconds ? std::optional(
                             static_cast<std::uint64_t>(std::clamp(std::trunc(*seconds * rate), 0.0, 4e9)))
                       : std::nullopt;
    };
    return frame_span(frame(segment.start), frame(segment.end), frames);
}

/// As the public tools name clips: segment, label, class from 1.
std::string clip_name(const Sequence& sequence, std::size_t label, std::uint32_t index) {
    const auto& id = sequence.segments[label].id;
    return fmt::format("{}_l{:02}_A{:03}", printable(id.empty() ? sequence.id : id), label, index + 1);
}

/// The part of feat_p, counted from its end.
std::string part_of(const std::string& feat_p, std::size_t from_end) {
    auto end = feat_p.size();
    for (std::size_t i = 0; i < from_end; ++i) {
        const auto slash = feat_p.rfind('/', end == 0 ? 0 : end - 1);
        if (slash == std::string::npos) return {};
        end = slash;
    }
    const auto begin = end == 0 ? std::string::npos : feat_p.rfind('/', end - 1);
    return printable(feat_p.substr(begin == std::string::npos ? 0 : begin + 1,
                                   end - (begin == std::string::npos ? 0 : begin + 1)));
}

std::string with_counts(const std::map<std::string, std::uint64_t>& counts) {
    std::vector<std::pair<std::uint64_t, std::string>> sorted;
    for (const auto& [name, count] : counts) sorted.emplace_back(count, name);
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
    constexpr std::size_t shown = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(sorted.size(), shown); ++i)
        text += fmt::format("{}{} {}", i > 0 ? ", " : "", printable(sorted[i].second), sorted[i].first);
    if (sorted.size() > shown) text += fmt::format(", and {} more", sorted.size() - shown);
    return text;
}

}  // namespace

const Annotations* BabelFormat::AnnotationFile::annotations() const {
    const auto* found = std::get_if<Annotations>(&said);
    return found && !found->several_annotators ? found : nullptr;
}

BabelFormat::BabelFormat(BabelOptions options)
    : options_(std::move(options)), target_(options_.rotational.target()) {
    if (!(options_.fps >= 1 && options_.fps <= 1000))
        throw Error("{} frames a second; give 1 to 1000", options_.fps);
    auto header = target_.header(options_.dataset);
    header.fps = options_.fps;
    header.classes = categories_called(options_.categories);
    if (header.classes.size() != babel_categories().size())
        header.origin.part = fmt::format("{} {}", header.classes.size(),
                                         header.classes.size() == 1 ? "category" : "categories");
    header.fields = {"split", "set", "subject", "sequence", "proc_label"};
    for (std::uint32_t i = 0; i < header.classes.size(); ++i) labels_.emplace(header.classes[i], i);
    datasets_.push_back(std::move(header));
}

bool BabelFormat::surveys_text_of(const RawText& raw) const {
    return is_json(raw);
}

void BabelFormat::survey(const RawText& raw) {
    if (is_json(raw)) {
        AnnotationFile file{std::string(raw.path), printable(raw.stem), read_annotations(raw.text)};
        const std::lock_guard lock(surveying_);
        annotations_.emplace(raw.index, std::move(file));
    } else {
        const std::lock_guard lock(surveying_);
        files_.emplace(raw.index, raw.path);
    }
}

void BabelFormat::settle() {
    gather_sequences();
    find_files();
    remark();
    settled_ = true;
}

void BabelFormat::gather_sequences() {
    std::string fault;
    std::set<std::string> splits;
    for (auto& [index, file] : annotations_) {
        file.first = sequences_.size();
        if (const auto* rejection = std::get_if<Rejection>(&file.said); rejection && fault.empty())
            fault = fmt::format("; {}: {}", printable(file.path), rejection->reason);
        const auto* annotations = file.annotations();
        if (!annotations) continue;
        for (const auto& sequence : annotations->sequences) sequences_.push_back({sequence, file.split});
        splits.insert(file.split);
    }
    if (sequences_.empty())
        throw Error(
            "no annotations of BABEL among the files: give train.json and val.json, or "
            "babel_v1.0_release.zip, beside "
            "the archives of AMASS{}",
            fault);
    for (const auto& split : splits) datasets_[0].splits.push_back({split, {{"split", {split}, false}}});
}

void BabelFormat::find_files() {
    SequenceFiles lookup;
    for (const auto& one : sequences_) lookup.add(one.sequence.feat_p);
    std::vector<std::string> without_subset;
    for (const auto& [index, path] : files_)
        if (auto found = lookup.of(path); !found.empty()) {
            for (const auto i : found) sequences_[i].found = true;
            of_file_.emplace(index, std::move(found));
            if (lookup.subset_of(path).empty())
                without_subset.push_back(part_of(path, 1) + "/" + part_of(path, 0));
        }
    if (of_file_.empty())
        throw Error(
            "none of {} files holds the motion of one of BABEL's {} sequences, as in {}; give the archives "
            "of AMASS, "
            "package SMPL+H G, or the folder they were unpacked to",
            files_.size(), sequences_.size(), printable(sequences_[0].sequence.feat_p));
    files_.clear();
    if (const auto count = without_subset.size(); count > 0)
        remarks_.push_back(
            fmt::format("{} {} matched by subject and trial alone ({}): {} folders name no subset of AMASS",
                        counted(count, "file"), count == 1 ? "is" : "are", first_few(without_subset),
                        count == 1 ? "its" : "their"));
}

void BabelFormat::remark() {
    std::map<std::string, std::uint64_t> others;
    std::vector<std::string> missing, extra;
    std::vector<bool> shown(datasets_[0].classes.size());
    std::uint64_t without = 0;
    for (const auto& one : sequences_) {
        if (!one.found) missing.push_back(printable(one.sequence.feat_p));
        for (const auto& segment : one.sequence.segments) {
            if (!one.found) continue;
            without += segment.categories.empty();
            for (const auto& category : segment.categories)
                if (const auto label = labels_.find(category); label != labels_.end())
                    shown[label->second] = true;
                else
                    ++others[category];
        }
    }
    for (const auto& [index, file] : annotations_)
        if (std::holds_alternative<Annotations>(file.said) && !file.annotations())
            extra.push_back(file.split + ".json");
    if (!missing.empty())
        remarks_.push_back(fmt::format("{} of {} sequences have no file here: {}", missing.size(),
                                       sequences_.size(), first_few(missing)));
    if (!others.empty())
        remarks_.push_back(fmt::format("labels of categories that are no classes: {}", with_counts(others)));
    if (without > 0) remarks_.push_back(fmt::format("labels without a category: {}", without));
    if (!extra.empty())
        remarks_.push_back(fmt::format("not used, as its labels are those of several annotators: {}",
                                       fmt::join(extra, ", ")));
    std::vector<std::string> unseen;
    for (std::size_t i = 0; i < shown.size(); ++i)
        if (!shown[i]) unseen.push_back(datasets_[0].classes[i]);
    if (!unseen.empty())
        remarks_.push_back(fmt::format("no label shows {} of the {} classes: {}; --categories names others",
                                       unseen.size(), shown.size(), first_few(unseen)));
    if (options_.published)
        remarks_.emplace_back("resampled as the public tools do; z points up, as they leave it");
}

std::string BabelFormat::settings() const {
    return fmt::format("babel: dataset '{}', {}, {} frames a second by {}, {} up, classes {}",
                       options_.dataset, target_.text(), options_.fps,
                       options_.published ? "the public tools' spline" : "slerp",
                       options_.published ? "z" : "y", fmt::join(datasets_[0].classes, ","));
}

std::optional<Rejection> BabelFormat::refuse(const RawText& raw) const {
    if (is_json(raw)) return {};
    if (holds_no_motion(raw.stem)) return dropped("holds no motion");
    if (settled_ && !of_file_.contains(raw.index)) return dropped("the annotations have no sequence of it");
    return {};
}

void BabelFormat::read(const RawText& raw, ClipSink& sink) const {
    if (is_json(raw)) {
        const auto file = annotations_.find(raw.index);
        if (file == annotations_.end()) throw Error("it could not be read when the files were looked at");
        return read_annotation_file(file->second, sink);
    }
    read_amass_file(raw.text, [&](const AmassRecording& recording) { cut_all(raw, recording, sink); });
}

/// What of its labels gives no clip, and why.
void BabelFormat::read_annotation_file(const AnnotationFile& file, ClipSink& sink) const {
    if (const auto* rejection = std::get_if<Rejection>(&file.said)) return sink.take(*rejection);
    const auto* annotations = file.annotations();
    if (!annotations) return;
    for (const auto& fault : annotations->faults) sink.take(fault);
    for (std::size_t i = 0; i < annotations->sequences.size(); ++i) {
        const auto& [sequence, split, found] = sequences_[file.first + i];
        if (!found) {
            sink.take(Rejection{
                Rejection::Kind::missing,
                fmt::format("sequence {}: no file {}", printable(sequence.id), printable(sequence.feat_p))});
            continue;
        }
        if (sequence.segments.empty())
            sink.take(dropped(fmt::format("sequence {}: no labels", printable(sequence.id))));
        for (std::size_t label = 0; label < sequence.segments.size(); ++label) {
            const auto& categories = sequence.segments[label].categories;
            if (categories.empty()) sink.take(dropped(place_of(sequence, label) + ": no category"));
            for (const auto& category : categories)
                if (!labels_.contains(category))
                    sink.take(dropped(fmt::format("{}: {} is none of the classes", place_of(sequence, label),
                                                  in_quotes(category))));
        }
    }
}

void BabelFormat::cut_all(const RawText& raw, const AmassRecording& recording, ClipSink& sink) const {
    std::vector<std::string> doubts;
    if (recording.smplx)
        doubts.emplace_back(
            "this is the SMPL-X package, whose frame rates are not always those that the labels were made "
            "with; take "
            "SMPL+H G");
    auto motion = options_.published ? zoomed(recording.motion, recording.fps, options_.fps)
                                     : resampled(recording.motion, recording.fps, options_.fps);
    if (!options_.published) turn(motion, z_up_to_y_up);
    const RotationalTrack track(motion, target_);
    for (const auto i : of_file_.at(raw.index)) cut(sequences_[i], track, doubts, sink);
}

void BabelFormat::cut(const Labelled& labelled, const RotationalTrack& track,
                      const std::vector<std::string>& doubts, ClipSink& sink) const {
    const auto& sequence = labelled.sequence;
    for (std::size_t label = 0; label < sequence.segments.size(); ++label) {
        const auto& segment = sequence.segments[label];
        const auto span = span_of(segment, track.frames(), options_.fps);
        for (const auto& category : segment.categories) {
            const auto found = labels_.find(category);
            if (found == labels_.end()) continue;
            if (span.empty()) {
                sink.take(dropped(fmt::format("{}: no frame from {} s to {} s; the motion has {:.2f} s",
                                              place_of(sequence, label), segment.start.value_or(0),
                                              segment.end.value_or(0), track.frames() / options_.fps)));
                continue;
            }
            auto clip = track.cut(span.first, span.last);
            clip->name = clip_name(sequence, label, found->second);
            clip->label = found->second;
            clip->fields = {labelled.split, part_of(sequence.feat_p, 2), part_of(sequence.feat_p, 1),
                            printable(sequence.id), printable(segment.text)};
            clip->doubts = doubts;
            span.add_doubts(clip->doubts);
            sink.take(std::move(clip));
        }
    }
}

kernels::CleanedBatch BabelFormat::clean(kernels::Device&, std::size_t,
                                         std::span<const std::unique_ptr<RawClip>> clips,
                                         std::vector<std::uint32_t>& frames) const {
    return gathered(clips, target_, frames);
}

}  // namespace actformer::ingest
