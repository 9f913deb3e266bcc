#include "eval/scoring/score.hpp"

#include <algorithm>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "eval/scoring/real_features.hpp"

namespace actformer::eval {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The clip that a window's name, as in "walk@60", tells.
std::string clip_of(const std::string& window) {
    return window.substr(0, window.rfind('@'));
}

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
    Aside aside(to);
    std::error_code error;
    fs::copy_file(from, aside.partial(), fs::copy_options::overwrite_existing, error);
    if (error) throw Error("{}: cannot be written: {}", to.string(), error.message());
    aside.commit();
}

void warn_of_lengths(ScoreReport& report, std::uint32_t window, const StoredFeatures& generated) {
    if (window == 0 || generated.longest == 0) return;
    if (generated.shortest == window && generated.longest == window) return;
    report.warnings.push_back(
        fmt::format("motions of {} frames are compared with windows of {}; --frames crops the motions, "
                    "--window cuts other windows",
                    generated.shortest == generated.longest
                        ? std::to_string(generated.longest)
                        : fmt::format("{} to {}", generated.shortest, generated.longest),
                    window));
}

/// Features of motions and of a dataset, as far as they are not at hand already.
class Maker {
  public:
    Maker(const ScoreRequest& request, const std::function<kernels::Device&()>& device,
          const ScoreEvents& events)
        : request_(request), device_(device), events_(events), dataset_(request.real) {
        const auto weights = read_weights(request.recogniser);
        check_fits(weights, dataset_);
        for (const auto& set : request.generated)
            if (!set.temporary) check_set(set, set.file(), weights);  // before the long work
        if (request.single_recogniser.empty()) return;
        if (dataset_.header().persons < 2)
            throw Error("{}: has one person a clip, for which --single-recogniser has no use",
                        request.real.string());
        check_fits(read_weights(request.single_recogniser), dataset_, true);
    }

    const ingest::Dataset& dataset() const { return dataset_; }

    Observed real() {
        Observed out = observed(real_features(false), request_.real.string());
        if (!request_.single_recogniser.empty()) {
            out.groups = real_features(true).samples;
            out.groups->classes = out.samples.classes;
        }
        if (!request_.keep.empty()) {
            fs::create_directories(request_.keep);
            copy_whole(kept_real_, request_.keep / "real.h5");
        }
        return out;
    }

    Observed generated(std::size_t repeat) {
        const auto& set = request_.generated[repeat];
        fs::path motions;
        const auto whole = features_of(set, false, motions);
        auto stored = read_features(whole);
        if (repeat == 0) first_ = {{}, {}, stored.shortest, stored.longest};
        auto out = observed(std::move(stored), set.name);
        if (!request_.single_recogniser.empty()) {
            out.groups = read_features(features_of(set, true, motions)).samples;
            out.groups->classes = out.samples.classes;
        }
        if (repeat == 0 && !request_.keep.empty()) copy_whole(whole, request_.keep / "generated.h5");
        if (set.temporary && !motions.empty()) fs::remove(motions);
        return out;
    }

    /// The first repeat's lengths.
    const StoredFeatures& first() const { return first_; }

  private:
    FeaturesRequest basics(bool apart) const {
        FeaturesRequest out;
        out.recogniser = apart ? request_.single_recogniser : request_.recogniser;
        out.window = request_.window;
        out.batch = request_.batch;
        out.persons_apart = apart;
        return out;
    }

    FeaturesRequest of_motions(const fs::path& motions, bool apart) const {
        auto out = basics(apart);
        out.input = motions;
        out.frames = request_.frames;
        out.labels = request_.labels;
        return out;
    }

    void check_set(const MotionSet& set, const fs::path& motions, const Weights& weights) const {
        if (!check_motions(of_motions(motions, false), weights))
            throw Error(
                "{}: the motions' names do not tell their action, as A001_0 does; name a file of labels with "
                "--labels",
                set.name);
    }

    Tell tell(const std::string& what) const {
        if (!events_.progress) return {};
        return [this, what](std::uint64_t done, std::uint64_t all) { events_.progress(what, done, all); };
    }

    StoredFeatures real_features(bool apart) {
        auto asked = basics(apart);
        asked.input = request_.real;
        asked.split = request_.split;
        asked.out = request_.work / (apart ? "real-groups.h5" : "real.h5");
        auto out = cached_features(asked, device_(), tell("real windows"));
        if (!apart) kept_real_ = out.file;
        return std::move(out.features);
    }

    /// The file with a set's features; makes it, and before it the motions, where need be.
    fs::path features_of(const MotionSet& set, bool apart, fs::path& motions) {
        const auto weights = basics(apart).recogniser;
        Checksum key;
        key.add(fmt::format("{}|{}|{}|{}|{}", set.key, apart, request_.frames, checksum_file(weights),
                            ACTFORMER_VERSION));
        for (const auto& [name, label] : request_.labels) key.add(fmt::format("|{}|{}", name, label));
        const auto features = request_.work / (key.hex() + ".h5");
        if (fs::exists(features)) return features;
        if (motions.empty()) {
            motions = set.file();
            if (!fs::is_regular_file(motions)) throw Error("{}: no motions came of it", set.name);
            if (set.temporary) check_set(set, motions, read_weights(request_.recogniser));
        }
        auto asked = of_motions(motions, apart);
        asked.out = features;
        make_features(asked, device_(), tell(set.name));
        return features;
    }

    const ScoreRequest& request_;
    const std::function<kernels::Device&()>& device_;
    const ScoreEvents& events_;
    ingest::Dataset dataset_;
    fs::path kept_real_;
    StoredFeatures first_;
};

Json provenance_of_motions(const ScoreRequest& request, const ingest::Dataset& dataset,
                           const std::string& device) {
    Json out{{"version", ACTFORMER_VERSION},
             {"recogniser",
              {{"path", request.recogniser.string()}, {"checksum", checksum_file(request.recogniser)}}}};
    if (!request.single_recogniser.empty())
        out["single_recogniser"] = {{"path", request.single_recogniser.string()},
                                    {"checksum", checksum_file(request.single_recogniser)}};
    out["real"] = {{"dataset", dataset.header().name},
                   {"path", request.real.string()},
                   {"fingerprint", dataset.fingerprint()},
                   {"split", request.split},
                   {"window", request.window}};
    out["generated"] = Json::array();
    for (const auto& set : request.generated) {
        Json one{{"name", set.name}, {"key", set.key}};
        if (set.seed) one["seed"] = *set.seed;
        out["generated"].push_back(one);
    }
    if (request.frames > 0) out["frames"] = request.frames;
    out["device"] = device;
    out["seed"] = request.options.seed;
    return out;
}

Scored score_motions(const ScoreRequest& request, const std::function<kernels::Device&()>& device,
                     const ScoreEvents& events) {
    if (request.generated.empty()) throw Error("no generated motions to score");
    Maker maker(request, device, events);
    Scored out;
    const auto real = maker.real();
    out.report = score_repeats(
        real, maker.dataset().header().classes, request.generated.size(),
        [&](std::size_t i) { return maker.generated(i); }, request.options);
    warn_of_lengths(out.report, request.window, maker.first());
    out.json = to_json(out.report);
    out.json["provenance"] = provenance_of_motions(request, maker.dataset(), device().info().name);
    return out;
}

Scored score_features(const ScoreRequest& request) {
    if (request.generated_features.empty()) throw Error("no generated features to score");
    auto stored = read_features(request.real_features);
    const auto window = stored.shortest == stored.longest ? stored.longest : 0;
    auto real = observed(std::move(stored), request.real_features.string());
    std::vector<StoredFeatures> files;
    for (const auto& path : request.generated_features) files.push_back(read_features(path));
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
            const auto& path = request.generated_features[i];
            checksums.push_back({{"name", path.string()}, {"key", checksum_file(path)}});
            widen(files[i].samples, real.samples.classes);
            return observed(files[i], path.string());
        },
        request.options);
    warn_of_lengths(out.report, window, files[0]);
    out.json = to_json(out.report);
    out.json["provenance"] = {
        {"version", ACTFORMER_VERSION},
        {"real",
         {{"path", request.real_features.string()}, {"checksum", checksum_file(request.real_features)}}},
        {"generated", checksums},
        {"seed", request.options.seed}};
    return out;
}

}  // namespace

MotionSet motions_in(const fs::path& file) {
    if (!fs::is_regular_file(file)) throw Error("{}: no such file of motions", file.string());
    return {file.string(), checksum_file(file), {}, [file] { return file; }, false};
}

Scored score(const ScoreRequest& request, const std::function<kernels::Device&()>& device,
             const ScoreEvents& events) {
    return request.real_features.empty() ? score_motions(request, device, events) : score_features(request);
}

}  // namespace actformer::eval
