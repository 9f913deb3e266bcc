#include "eval/scoring/features.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/metrics/fid.hpp"
#include "eval/scoring/features_file.hpp"
#include "eval/stgcn/recogniser.hpp"
#include "eval/stgcn/tuning.hpp"
#include "ingest/dataset/view.hpp"

namespace actformer::eval {
namespace {

namespace fs = std::filesystem;

/// Counts how many logits are largest where the label says.
struct Hits {
    std::uint64_t right = 0, all = 0;

    void add(std::span<const float> logits, std::uint32_t label) {
        right += static_cast<std::uint64_t>(std::max_element(logits.begin(), logits.end()) -
                                            logits.begin()) == label;
        ++all;
    }
    std::optional<double> rate() const {
        if (all == 0) return {};
        return static_cast<double>(right) / static_cast<double>(all);
    }
};

void note_origin(FeaturesFile& file, const FeaturesRequest& request) {
    file.note("version", ACTFORMER_VERSION);
    file.note("recogniser", checksum_file(request.recogniser));
}

kernels::Tiles tiles_for(const kernels::Device& device, std::uint32_t batch) {
    auto tiles = load_tiles(device.info());
    tiles.sequences = std::min(tiles.sequences, batch);
    return tiles;
}

/// A motion's place in the output, which follows the names.
struct Entry {
    std::string name;
    std::uint64_t row = 0;
};

/// A motions file, checked against the recogniser: which motions have which length.
struct MotionList {
    std::vector<std::string> names;
    std::map<std::uint32_t, std::vector<Entry>> by_frames;
    std::vector<std::uint32_t> labels;  ///< of all names, or empty
    std::uint32_t seen_a_motion = 1;    ///< sequences that the recogniser is shown of each
};

/// Sequences that a recogniser of `channels` channels sees of a motion of `stored` channels; none where it cannot.
std::uint32_t sequences_of(std::uint64_t stored, std::uint32_t channels, bool persons_apart) {
    if (!persons_apart) return stored == channels;
    return static_cast<std::uint32_t>(channels > 0 && stored % channels == 0 ? stored / channels : 0);
}

void check_shape(const hdf5::Shape& shape, const std::string& name, const FeaturesRequest& request,
                 const Weights& weights) {
    const auto where = request.input.string();
    if (shape.size() != 3 || shape[0] % 3 != 0) throw Error("{}: '{}' is no (P*3, K, T) array", where, name);
    if (sequences_of(shape[0], weights.channels, request.persons_apart) == 0 || shape[1] != weights.joints())
        throw Error(
            "{}: '{}' has {} channels and {} joints where the recogniser {} takes {} and {}; choose one "
            "trained on such motions",
            where, name, shape[0], shape[1], weights.source, weights.channels, weights.joints());
    if (shape[2] == 0 || shape[2] < request.frames)
        throw Error("{}: '{}' has {} frames, fewer than {}; ask for fewer with --frames", where, name,
                    shape[2], std::max(request.frames, 1U));
}

/// As given, or as all names tell; else none.
std::vector<std::uint32_t> labels_of(const std::vector<std::string>& names, const FeaturesRequest& request,
                                     const Weights& weights) {
    std::vector<std::uint32_t> labels;
    for (const auto& name : names) {
        auto label = label_in(name);
        if (!request.labels.empty()) {
            const auto given = request.labels.find(name);
            if (given == request.labels.end())
                throw Error("{}: '{}' has no line in the labels given", request.input.string(), name);
            label = given->second;
        }
        if (!label) return {};
        if (!request.persons_apart && *label >= weights.classes)
            throw Error("{}: '{}' is of action {} and the recogniser {} knows {} classes",
                        request.input.string(), name, *label + 1, weights.source, weights.classes);
        labels.push_back(*label);
    }
    return labels;
}

MotionList list_motions(const hdf5::Reader& file, const FeaturesRequest& request, const Weights& weights) {
    MotionList list;
    for (const auto& name : file.names()) {
        if (!file.is_array(name)) continue;
        const auto shape = file.shape(name);
        check_shape(shape, name, request, weights);
        const auto seen = sequences_of(shape[0], weights.channels, request.persons_apart);
        if (!list.names.empty() && seen != list.seen_a_motion)
            throw Error("{}: '{}' has {} persons and '{}' has {}; score groups of one size at a time",
                        request.input.string(), name, seen, list.names[0], list.seen_a_motion);
        list.seen_a_motion = seen;
        const auto frames = request.frames ? request.frames : static_cast<std::uint32_t>(shape[2]);
        list.by_frames[frames].push_back({name, list.names.size()});
        list.names.push_back(name);
    }
    if (list.names.empty())
        throw Error("{}: holds no motions; one (P*C, K, T) array a clip is expected", request.input.string());
    list.labels = labels_of(list.names, request, weights);
    return list;
}

/// Of groups whose persons were seen one after another: the group's features, and no logits.
Recognised grouped(Recognised seen, const FeaturesRequest& request, const Weights& weights,
                   std::uint32_t persons) {
    if (!request.persons_apart) return seen;
    return {largest_of_group(seen.features, weights.features(), persons), {}};
}

/// Appends the first `frames` frames of a stored (C, K, T) motion as (C, frames, K).
void append_motion(const hdf5::Reader& file, const std::string& where, const std::string& name,
                   std::uint32_t frames, std::vector<float>& to) {
    const auto shape = file.shape(name);
    const auto stored = file.read<float>(name);
    if (!std::all_of(stored.begin(), stored.end(), [](float v) { return std::isfinite(v); }))
        throw Error("{}: '{}' holds numbers that are not finite", where, name);
    for (std::size_t c = 0; c < shape[0]; ++c)
        for (std::size_t t = 0; t < frames; ++t)
            for (std::size_t k = 0; k < shape[1]; ++k)
                to.push_back(stored[(c * shape[1] + k) * shape[2] + t]);
}

/// Room for as many windows as asked for, or as the device's memory holds.
kernels::Batch make_batch(const kernels::ClipStore& clips, std::size_t samples, std::uint32_t window) {
    while (true) {
        try {
            return {clips, static_cast<std::uint32_t>(samples), window};
        } catch (const OutOfMemory&) {
            if (samples == 1) throw;
            samples /= 2;
        }
    }
}

FeaturesSummary features_of_motions(const FeaturesRequest& request, const Weights& weights,
                                    kernels::Device& device, const Tell& tell) {
    const hdf5::Reader input(request.input);
    const auto list = list_motions(input, request, weights);
    StgcnRecogniser recogniser(device, weights, tiles_for(device, request.batch));
    const std::uint32_t classes = request.persons_apart ? 0 : weights.classes;
    FeaturesFile out(request.out, list.names.size(), weights.features(), classes);
    std::uint64_t done = 0;
    Hits hits;
    for (const auto& [frames, entries] : list.by_frames)
        for (std::size_t first = 0; first < entries.size(); first += request.batch) {
            const auto count = std::min<std::size_t>(request.batch, entries.size() - first);
            std::vector<float> motions;
            for (std::size_t i = 0; i < count; ++i)
                append_motion(input, request.input.string(), entries[first + i].name, frames, motions);
            const auto sequences = static_cast<std::uint32_t>(count) * list.seen_a_motion;
            const auto got = grouped(recogniser.recognise(motions, sequences, frames), request, weights,
                                     list.seen_a_motion);
            for (std::size_t i = 0; i < count; ++i) {
                const auto row = entries[first + i].row;
                const auto logits = std::span(got.logits).subspan(i * classes, classes);
                out.add(row, std::span(got.features).subspan(i * weights.features(), weights.features()),
                        logits);
                if (!list.labels.empty() && classes > 0) hits.add(logits, list.labels[row]);
            }
            done += count;
            if (tell) tell(done, list.names.size());
        }
    out.names(list.names);
    out.frames(list.by_frames.begin()->first, list.by_frames.rbegin()->first);
    if (!list.labels.empty()) out.labels(list.labels);
    note_origin(out, request);
    out.note("input", checksum_file(request.input));
    out.note("view", request.frames ? fmt::format("first {} frames", request.frames) : "whole motions");
    out.finish();
    return {list.names.size(), classes, weights.features(), !list.labels.empty(), hits.rate()};
}

FeaturesSummary features_of_dataset(const FeaturesRequest& request, const Weights& weights,
                                    kernels::Device& device, const Tell& tell) {
    const ingest::Dataset dataset(request.input);
    check_fits(weights, dataset, request.persons_apart);
    const auto view = ingest::load_view(device, dataset, request.split);
    const auto windows = kernels::consecutive_windows(view.store.table().frames, request.window);
    const kernels::WindowCutter cutter(view.store, windows);
    auto batch = make_batch(view.store, std::min<std::size_t>(request.batch, windows.size()), request.window);
    StgcnRecogniser recogniser(device, weights, tiles_for(device, request.batch));
    const std::uint32_t classes = request.persons_apart ? 0 : weights.classes;
    const auto persons = request.persons_apart ? dataset.header().persons : 1;
    FeaturesFile out(request.out, windows.size(), weights.features(), classes);
    Hits hits;
    for (std::size_t first = 0; first < windows.size(); first += batch.filled()) {
        cutter.cut(first, batch);
        const auto got =
            grouped(recogniser.recognise(batch.values(), batch.filled() * persons, request.window), request,
                    weights, persons);
        out.add(first, got.features, got.logits);
        for (std::size_t i = 0; i < batch.filled() && classes > 0; ++i)
            hits.add(std::span(got.logits).subspan(i * classes, classes),
                     view.store.table().labels[windows[first + i].clip]);
        if (tell) tell(first + batch.filled(), windows.size());
    }
    std::vector<std::string> names;
    std::vector<std::uint32_t> labels;
    for (const auto& window : windows) {
        names.push_back(fmt::format("{}@{}", dataset.clips()[view.clips[window.clip]].name, window.first));
        labels.push_back(view.store.table().labels[window.clip]);
    }
    out.names(names);
    out.labels(labels);
    out.frames(request.window, request.window);
    note_origin(out, request);
    out.note("input", dataset.fingerprint());
    out.note("view", fmt::format("split {}, windows of {} frames", request.split, request.window));
    out.finish();
    return {windows.size(), classes, weights.features(), true, hits.rate()};
}

}  // namespace

std::optional<std::uint32_t> label_in(const std::string& name) {
    const auto at = name.rfind('A');
    if (at == std::string::npos) return {};
    std::uint32_t action = 0;
    const char *begin = name.data() + at + 1, *end = name.data() + name.size();
    const auto [rest, error] = std::from_chars(begin, end, action);
    if (error != std::errc() || rest - begin < 3 || action == 0) return {};
    if (rest == end) return action - 1;  // S001C001P001R001A001
    if (at != 0 || *rest != '_' || rest + 1 == end) return {};
    if (!std::all_of(rest + 1, end, [](char c) { return c >= '0' && c <= '9'; })) return {};
    return action - 1;  // A001_7
}

void check_fits(const Weights& weights, const ingest::Dataset& dataset, bool persons_apart) {
    const auto& header = dataset.header();
    const auto where = dataset.folder().string();
    const auto persons = persons_apart ? 1 : header.persons;
    if (persons_apart && weights.channels != 3)
        throw Error("{}: takes {} persons; the one that sees the persons of {} alone must take one",
                    weights.source, weights.channels / 3, where);
    if (persons * 3 != weights.channels)
        throw Error(
            "{}: has {} persons a clip and the recogniser {} takes {}; choose one trained on such a dataset",
            where, persons, weights.source, weights.channels / 3);
    if (header.topology.joints() != weights.joints())
        throw Error("{}: has {} joints and the recogniser {} takes {}; choose one trained on such a dataset",
                    where, header.topology.joints(), weights.source, weights.joints());
    const auto& parents = weights.graph.parents;
    if (parents != header.topology.parents && parents != recogniser_graph(header.topology).parents)
        throw Error(
            "{}: its skeleton is another tree than that of the recogniser {}; choose one trained on such a "
            "dataset",
            where, weights.source);
    if (!persons_apart && header.classes.size() != weights.classes)
        throw Error("{}: has {} classes and the recogniser {} knows {}; choose one trained on such a dataset",
                    where, header.classes.size(), weights.source, weights.classes);
}

bool check_motions(const FeaturesRequest& request, const Weights& weights) {
    return !list_motions(hdf5::Reader(request.input), request, weights).labels.empty();
}

FeaturesSummary make_features(const FeaturesRequest& request, kernels::Device& device, const Tell& tell) {
    if (request.batch == 0) throw Error("--batch 0: at least one sequence must go to the device at once");
    const auto weights = read_weights(request.recogniser);
    if (!fs::exists(request.input)) throw Error("{}: no such file or folder", request.input.string());
    return fs::is_directory(request.input) ? features_of_dataset(request, weights, device, tell)
                                           : features_of_motions(request, weights, device, tell);
}

}  // namespace actformer::eval
