#include "eval/scoring/score.hpp"

#include <algorithm>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/files/work_folder.hpp"
#include "eval/scoring/measured_motions.hpp"
#include "eval/scoring/measures_file.hpp"
#include "eval/scoring/real_features.hpp"
#include "ingest/dataset/dataset_json.hpp"

namespace actformer::eval {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Persons = FeatureExtractor::Persons;

// In the work folder: of the real side, where the user's cache cannot be written.
constexpr const char* real_file = "real.h5";
constexpr const char* real_groups_file = "real-groups.h5";

Observed observed(StoredFeatures stored, std::string source) {
    Observed out;
    out.samples = std::move(stored.samples);
    for (const auto& name : stored.names) out.clips.push_back(clip_of(name));
    out.source = std::move(source);
    return out;
}

/// A side with as many classes as the other, where one of them tells no more than its highest label.
void widen(Samples& samples, std::size_t classes) {
    if (samples.logits.empty()) samples.classes = std::max(samples.classes, classes);
}

void copy_whole(const fs::path& from, const fs::path& to) {
    Aside file(to);
    read_in_pieces(from, [&](std::string_view piece) { file.write(piece); });
    file.commit();
}

/// Frames of the motions of some files that tell them.
struct Lengths {
    std::uint32_t shortest = 0, longest = 0;  ///< 0: no file told

    void add(const StoredFeatures& file) {
        if (file.longest == 0) return;
        shortest = longest == 0 ? file.shortest : std::min(shortest, file.shortest);
        longest = std::max(longest, file.longest);
    }
};

void warn_of_lengths(ScoreReport& report, std::uint32_t window, const Lengths& generated) {
    if (window == 0 || generated.longest == 0) return;
    if (generated.shortest == window && generated.longest == window) return;
    report.warnings.push_back(
        fmt::format("motions of {} frames are compared with windows of {}; make features of as many frames "
                    "(`score` of motions takes --frames and --window)",
                    generated.shortest == generated.longest
                        ? std::to_string(generated.longest)
                        : fmt::format("{} to {}", generated.shortest, generated.longest),
                    window));
}

/// Features of both sides, as far as they are not at hand already.
class Sides {
  public:
    Sides(const ScoreMotions& request, kernels::Device& device, const ScoreProgress& progress)
        : request_(request),
          device_(device),
          progress_(progress),
          dataset_(request.real.dataset),
          dataset_checksum_(ingest::dataset_checksum(request.real.dataset)),
          setup_(measurement_setup(dataset_)) {
        if (!request.recogniser.empty())
            whole_.emplace(device, request.recogniser, request.real.batch, Persons::together,
                           request.initial_noise);
        if (!request.single_recogniser.empty())
            single_.emplace(device, request.single_recogniser, request.real.batch, Persons::apart);
        check();
    }

    const std::vector<std::string>& classes() const { return classes_; }
    const ingest::Dataset& dataset() const { return dataset_; }
    const std::optional<FeatureExtractor>& whole() const { return whole_; }
    const std::optional<FeatureExtractor>& single() const { return single_; }

    Observed real() {
        auto cached = real_features(first(), real_file);
        add_note(cached.note);
        if (!request_.keep.empty()) {
            make_folders(request_.keep);
            copy_whole(cached.file, request_.keep / "real.h5");
        }
        auto out = observed(std::move(cached.features), request_.real.dataset.string());
        if (whole_ && single_) {
            auto groups = real_features(*single_, real_groups_file);
            add_note(groups.note);
            add_groups(out, std::move(groups.features));
        }
        out.motion = real_measures();
        return with_classes(std::move(out));
    }

    Observed generated(std::size_t repeat) {
        const auto& set = request_.generated[repeat];
        const auto file = file_of(set, first());
        make_missing(set);
        auto stored = read_features(file);
        done_ += stored.names.size();
        lengths_.add(stored);
        if (repeat == 0 && !request_.keep.empty()) copy_whole(file, request_.keep / "generated.h5");
        auto out = observed(std::move(stored), set.name);
        if (whole_ && single_) add_groups(out, read_features(file_of(set, *single_)));
        if (fs::exists(measures_of(set.key))) out.motion = read_measures(measures_of(set.key));
        return with_classes(std::move(out));
    }

    /// What is shown of each motion, set by set.
    const std::vector<std::string>& views() const { return views_; }

    /// What was kept, damaged, and has been made anew.
    const std::vector<std::string>& notes() const { return notes_; }

    /// Of the motions of all repeats so far.
    const Lengths& lengths() const { return lengths_; }

  private:
    /// Whose features are the samples; the one-person recogniser's are the groups where it is not the only one.
    FeatureExtractor& first() { return whole_ ? *whole_ : *single_; }

    /// Features of groups have no logits, which would tell how many classes there are.
    Observed with_classes(Observed side) const {
        side.of_groups = !whole_;
        if (side.of_groups) side.samples.classes = classes_.size();
        return side;
    }

    static void add_groups(Observed& side, StoredFeatures stored) {
        side.groups = std::move(stored.samples);
        side.groups->classes = side.samples.classes;
    }

    /// Refuses before the long work what would fail after it.
    void check() {
        const auto real = open_windows(device_, request_.real);
        classes_ = real->info().classes;
        if (whole_) check_real(*whole_, real->info());
        if (whole_) whole_->check_classes(real->info());
        if (single_) check_real(*single_, real->info());
        if (single_ && real->info().persons < 2)
            throw Error("{}: has one person a clip, for which --single-recogniser has no use",
                        request_.real.dataset.string());
        all_ += real->info().names.size() * (whole_ && single_ ? 2 : 1);
        for (const auto& set : request_.generated) {
            const auto motions = set.open();
            check_set(set, motions->info());
            all_ += motions->info().names.size();
            views_.push_back(motions->info().view);
        }
    }

    /// Windows come in the joints that the extractor must be shown.
    void check_real(const FeatureExtractor& extractor, const MotionsInfo& own) const {
        const auto joints = extractor.joints_of(own);
        extractor.check_fits(joints == ingest::Joints::own ? own : describe(dataset_, joints));
    }

    void check_side(const MotionsInfo& motions) const {
        if (whole_) whole_->check_fits(motions);
        if (whole_) whole_->check_classes(motions);
        if (single_) single_->check_fits(motions);
    }

    void check_set(const MotionSet& set, const MotionsInfo& motions) const {
        check_side(motions);
        if (!motions.classes.empty() && motions.classes != classes_)
            throw Error("{}: its classes are not those of {}; score motions of the same classes", set.name,
                        request_.real.dataset.string());
        if (motions.labels.empty())
            throw Error(
                "{}: not every motion tells its action, by a name like A001_0 or the attribute `label`; "
                "`score --labels` takes a file of them",
                set.name);
    }

    /// Of one pass over a side or a set, after those before it.
    OnProgress tell() const {
        if (!progress_) return {};
        return [this](std::uint64_t done, std::uint64_t) { progress_(done_ + done, all_); };
    }

    WindowsOptions windows_for(const FeatureExtractor& extractor) const {
        auto windows = request_.real;
        windows.joints = extractor.joints_of(describe(dataset_));
        return windows;
    }

    CachedFeatures real_features(FeatureExtractor& extractor, const char* elsewhere) {
        auto out =
            cached_features(extractor, windows_for(extractor), request_.work / elsewhere, device_, tell());
        done_ += out.features.names.size();
        return out;
    }

    fs::path file_of(const MotionSet& set, const FeatureExtractor& extractor) const {
        Checksum key;
        key.add(fmt::format("{}|{}|{}|{}", set.key, extractor.persons() == Persons::apart,
                            extractor.checksum(), ACTFORMER_VERSION));
        return request_.work / (key.hex() + ".h5");
    }

    /// How motions are measured is the dataset's: its bodies' lengths and frames a second. What was kept before roots had a speed
    /// is measured anew.
    fs::path measures_of(const std::string& motions) const {
        Checksum key;
        key.add(fmt::format("{}|{}|{}|root speed", motions, dataset_checksum_, ACTFORMER_VERSION));
        return request_.work / (key.hex() + ".measures");
    }

    fs::path real_measures_file() const {
        return measures_of(fmt::format("real|{}|{}", request_.real.split, request_.real.window));
    }

    void add_note(const std::string& note) {
        if (!note.empty()) notes_.push_back(note);
    }

    /// Whether an interrupted scoring left it, as it was written.
    bool is_kept(const fs::path& file) {
        if (!fs::exists(file)) return false;
        if (is_as_written(file)) return true;
        add_note(fmt::format("{}: damaged, or of an earlier version; made anew", file.string()));
        fs::remove(file);
        return false;
    }

    /// Of the real windows; they lie in the work folder until scoring has ended.
    std::optional<MotionMeasures> real_measures() {
        if (!setup_) return {};
        const auto file = real_measures_file();
        if (is_kept(file)) return read_measures(file);
        MeasuredSource real(open_windows(device_, request_.real), *setup_, device_);
        while (!real.next().rows.empty()) continue;
        write_measures(file, real.measures());
        return real.measures();
    }

    /// The features and measures of a set that are not there yet, in one pass over its motions.
    void make_missing(const MotionSet& set) {
        std::vector<FeaturesTarget> missing;
        for (auto* extractor : {whole_ ? &*whole_ : nullptr, single_ ? &*single_ : nullptr})
            if (extractor && !is_kept(file_of(set, *extractor)))
                missing.push_back({extractor, file_of(set, *extractor)});
        auto motions = set.open();
        if (!setup_ || !fits(*setup_, motions->info()) || is_kept(measures_of(set.key))) {
            if (!missing.empty()) write_features(*motions, missing, tell());
            return;
        }
        MeasuredSource measured(std::move(motions), *setup_, device_);
        if (missing.empty())
            while (!measured.next().rows.empty()) continue;
        else
            write_features(measured, missing, tell());
        write_measures(measures_of(set.key), measured.measures());
    }

    const ScoreMotions& request_;
    kernels::Device& device_;
    const ScoreProgress& progress_;
    ingest::Dataset dataset_;
    std::string dataset_checksum_;
    std::optional<MeasurementSetup> setup_;  ///< none where motions cannot be measured
    std::optional<FeatureExtractor> whole_, single_;
    std::vector<std::string> classes_, views_, notes_;
    Lengths lengths_;
    std::uint64_t done_ = 0, all_ = 0;  ///< sequences of all sides; done are those whose features are there
};

Json provenance_of_motions(const ScoreMotions& request, const Sides& sides, const std::string& device) {
    const auto& dataset = sides.dataset();
    const auto recogniser = [](const FeatureExtractor& extractor) {
        return Json{{"path", printable(extractor.weights().string())}, {"checksum", extractor.checksum()}};
    };
    Json out{{"version", ACTFORMER_VERSION}};
    if (sides.whole()) out["recogniser"] = recogniser(*sides.whole());
    if (sides.single()) out["single_recogniser"] = recogniser(*sides.single());
    out["real"] = {{"dataset", dataset.header().name},
                   {"path", printable(request.real.dataset.string())},
                   {"fingerprint", dataset.fingerprint()},
                   {"split", printable(request.real.split)},
                   {"window", request.real.window}};
    if (const auto origin = ingest::to_json(dataset.header().origin); !origin.empty())
        out["real"]["origin"] = origin;
    out["generated"] = Json::array();
    for (std::size_t i = 0; i < request.generated.size(); ++i) {
        const auto& set = request.generated[i];
        Json one{{"name", printable(set.name)}, {"key", set.key}, {"view", sides.views()[i]}};
        if (set.seed) one["seed"] = *set.seed;
        out["generated"].push_back(one);
    }
    out["device"] = device;
    out["seed"] = request.options.seed;
    return out;
}

}  // namespace

Scored score_motions(const ScoreMotions& request, kernels::Device& device, const ScoreProgress& progress) {
    if (request.generated.empty()) throw Error("no generated motions to score");
    Sides sides(request, device, progress);
    Scored out;
    const auto real = sides.real();
    out.report = score_repeats(
        real, sides.classes(), request.generated.size(), [&](std::size_t i) { return sides.generated(i); },
        request.options);
    warn_of_lengths(out.report, request.real.window, sides.lengths());
    out.json = to_json(out.report);
    out.json["provenance"] = provenance_of_motions(request, sides, device.info().name);
    out.notes = sides.notes();
    return out;
}

bool is_kept_by_score(const fs::path& below) {
    if (below.has_parent_path()) return false;
    if (is_called(below, real_file) || is_called(below, real_groups_file)) return true;
    const auto key = below.native().substr(0, below.native().find('.'));
    return key.size() == 32 && key.find_first_not_of("0123456789abcdef") == std::string::npos &&
           (is_called(below, key + ".h5") || is_called(below, key + ".measures"));
}

Scored score_features(const ScoreFeatures& request) {
    if (request.generated.empty()) throw Error("no generated features to score");
    auto stored = read_features(request.real);
    const auto window = stored.shortest == stored.longest ? stored.longest : 0;
    auto real = observed(std::move(stored), request.real.string());
    std::vector<StoredFeatures> files;
    Lengths lengths;
    for (const auto& path : request.generated) {
        files.push_back(read_features(path));
        lengths.add(files.back());
    }
    for (auto& file : files) {
        widen(real.samples, file.samples.classes);
        widen(file.samples, real.samples.classes);
    }
    std::vector<std::string> classes;
    for (std::size_t c = 0; c < real.samples.classes; ++c) classes.push_back(fmt::format("A{:03}", c + 1));
    Scored out;
    Json checksums = Json::array();
    out.report = score_repeats(
        real, std::move(classes), files.size(),
        [&](std::size_t i) {
            const auto& path = request.generated[i];
            checksums.push_back({{"name", printable(path.string())}, {"key", checksum_file(path)}});
            widen(files[i].samples, real.samples.classes);
            return observed(files[i], path.string());
        },
        request.options);
    warn_of_lengths(out.report, window, lengths);
    out.json = to_json(out.report);
    out.json["provenance"] = {
        {"version", ACTFORMER_VERSION},
        {"real", {{"path", printable(request.real.string())}, {"checksum", checksum_file(request.real)}}},
        {"generated", checksums},
        {"seed", request.options.seed}};
    return out;
}

}  // namespace actformer::eval
