#include "reports/page/details.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/text/loose_json.hpp"
#include "eval/scoring/features_file.hpp"
#include "ingest/dataset/dataset.hpp"
#include "reports/motions/gather.hpp"
#include "reports/page/curves.hpp"
#include "reports/page/moving.hpp"
#include "reports/page/packed.hpp"
#include "reports/page/projection.hpp"
#include "reports/page/tables.hpp"

namespace actformer::reports {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t usual_frames = 60;  // a window's, where the scores do not tell
constexpr std::size_t most_sides = 8;       // of a comparison; `actformer compare` makes two

/// The classes of a row that have anything to show, and their places among them.
struct Classes {
    std::vector<std::uint32_t> labels;
    std::map<std::uint32_t, std::size_t> places;

    std::optional<std::size_t> place(std::uint32_t label) const {
        const auto found = places.find(label);
        return found == places.end() ? std::nullopt : std::optional(found->second);
    }
};

bool is_matrix(const Json& confusion, std::size_t n) {
    return confusion.is_array() && confusion.size() == n &&
           std::ranges::all_of(confusion, [n](const Json& row) {
               return row.is_array() && row.size() == n &&
                      std::ranges::all_of(row, [](const Json& v) { return v.is_number_unsigned(); });
           });
}

/// Those with samples on a side, or that samples were taken for.
Classes classes_of(const Json& scored) {
    Classes out;
    const auto &all = loose::list(scored, "per_class"), &confusion = loose::member(scored, "confusion");
    const bool matrix = is_matrix(confusion, all.size());
    const auto count = [](const Json& one, const char* key) {
        const auto& value = loose::member(one, key);
        return value.is_number() ? value.get<double>() : 0;
    };
    for (std::uint32_t c = 0; c < all.size(); ++c) {
        const bool taken =
            matrix && std::ranges::any_of(confusion, [c](const Json& row) { return row[c] != 0; });
        if (count(all[c], "real") + count(all[c], "generated") == 0 && !taken) continue;
        out.places[c] = out.labels.size();
        out.labels.push_back(c);
    }
    return out;
}

Json scaled(const Json& value, double scale) {
    return value.is_number() ? Json(scale * value.get<double>()) : Json();
}

/// What `score` measured of the metrics known, with what real motions come to: [{"heading", "unit", "value", "real", "floor"}]
Json scores_of(const Json& scored) {
    Json out = Json::array();
    for (const auto& [name, measured] : scored.items()) {
        const auto& mean = loose::member(measured, "mean");
        const auto* how = eval::find_metric(name);
        if (!mean.is_number() || !how) continue;
        out.push_back(
            {{"heading", how->heading},
             {"unit", how->unit},
             {"value", scaled(mean, how->scale)},
             {"real", scaled(loose::member(loose::member(scored, "real"), name.c_str()), how->scale)},
             {"floor", scaled(loose::member(loose::member(scored, "floor"), name.c_str()), how->scale)}});
    }
    return out;
}

/// A metric of each class: its key in the scores' "per_class", the metric of all classes that is made of it, and the key of what
/// real motions come to against one another.
struct ClassMetric {
    const char *key, *heading, *metric, *floor;
};
constexpr ClassMetric class_metrics[] = {{"accuracy", "accuracy", "accuracy", nullptr},
                                         {"fid", "FID", "fid_mean", "floor"},
                                         {"fida", "FIDa", "fida_mean", "fida_floor"}};

/// [{"key", "heading", "unit", "better", "floor"}]: the columns of per_class()
Json class_columns() {
    Json out = Json::array();
    for (const auto& one : class_metrics) {
        const auto& how = scored_metric(one.metric);
        out.push_back({{"key", one.key},
                       {"heading", one.heading},
                       {"unit", how.unit},
                       {"better", name_of(how.direction)},
                       {"floor", one.floor ? Json(one.floor) : Json()}});
    }
    return out;
}

Json per_class(const Json& scored, const Classes& classes) {
    Json out = Json::array();
    for (const auto label : classes.labels) {
        Json one;
        const auto& said = scored["per_class"][label];
        for (const char* key : {"real", "generated"}) one[key] = loose::member(said, key);
        for (const auto& metric : class_metrics) {
            const auto scale = scored_metric(metric.metric).scale;
            one[metric.key] = scaled(loose::member(said, metric.key), scale);
            if (metric.floor) one[metric.floor] = scaled(loose::member(said, metric.floor), scale);
        }
        out.push_back(one);
    }
    return out;
}

Json confusion_of(const Json& scored, const Classes& classes) {
    const auto& all = loose::member(scored, "confusion");
    if (!is_matrix(all, loose::list(scored, "per_class").size())) return {};
    Json out = Json::array();
    for (const auto asked : classes.labels) {
        Json row = Json::array();
        for (const auto taken : classes.labels) row.push_back(all[asked][taken]);
        out.push_back(row);
    }
    return out;
}

void add_scores(Json& row, const Json& scored, const Classes& classes) {
    row["classes"] = Json::array();
    for (const auto label : classes.labels) {
        const auto& name = loose::member(scored["per_class"][label], "class");
        row["classes"].push_back(name.is_string() ? name : Json(fmt::format("class {}", label + 1)));
    }
    row["scores"] = scores_of(scored);
    row["warnings"] = loose::list(scored, "warnings");
    row["per_class"] = per_class(scored, classes);
    row["confusion"] = confusion_of(scored, classes);
}

/// A cell's name as people say it: "Table 3 · full · NTU-1P".
std::string cell_in_words(const std::string& name, const std::vector<PaperTable>& tables) {
    try {
        return words_of(find_cell(name, tables));
    } catch (const Error&) {
        return name;
    }
}

/// What is left of the motions for the page to stay small: motions a class, every n-th frame, every n-th class.
struct Thinning {
    std::uint32_t samples = 4, frame_step = 1, class_step = 1;
};

/// Fewer samples first, then fewer frames, then fewer classes, until `full` bytes, which four samples a class at all frames come to,
/// are within `room`.
Thinning thinning(double full, double most_samples, double room) {
    const auto fits = [&](const Thinning& t) {
        return full * (t.samples / most_samples) / t.frame_step / t.class_step <= room;
    };
    Thinning out{static_cast<std::uint32_t>(most_samples), 1, 1};
    while (!fits(out) && out.samples > 2) --out.samples;
    if (!fits(out)) out.frame_step = 2;
    if (!fits(out)) out.samples = 1;
    while (!fits(out) && out.class_step < 1000) ++out.class_step;
    return out;
}

/// Builds the page's data row by row; what rows share is made once.
class Details {
  public:
    Details(Measured& measured, const DetailOptions& options) : measured_(measured), options_(options) {
        for (std::size_t i = 0; i < measured.rows.size(); ++i)
            if (const auto of = measured.rows[i].comparison) sides_[*of].push_back(i);
    }

    Json all() {
        out_ = {{"version", ACTFORMER_VERSION}, {"class_columns", class_columns()},
                {"rows", Json::array()},        {"projections", Json::array()},
                {"topologies", Json::array()},  {"motion_sets", Json::array()}};
        thinning_ =
            thinning(motion_bytes(), options_.most_samples, static_cast<double>(options_.motion_bytes));
        if (thinning_.class_step > 1)
            measured_.notices.push_back(fmt::format(
                "to keep this file small, motions are shown of one class in {} only", thinning_.class_step));
        for (const auto& row : measured_.rows) out_["rows"].push_back(row_json(row));
        return std::move(out_);
    }

  private:
    Json row_json(const MeasuredRow& row) {
        Json out{{"name", row.name},       {"sweep", row.sweep},   {"compared", compared_with(row)},
                 {"fills", Json::array()}, {"status", row.status}, {"why", row.why}};
        for (const auto& cell : row.fills) out["fills"].push_back(cell_in_words(cell, measured_.tables));
        const auto* run = row.shown();
        static const Json none;
        const auto& scored = run ? run->scored : none;
        const auto classes = classes_of(scored);
        add_scores(out, scored, classes);
        const auto* trained = row.trained();
        out["curves"] = {{"generator", nullptr}, {"recogniser", nullptr}};
        if (trained) add_curves(out["curves"], row, *trained);
        out["projection"] = out["points"] = out["motions"] = nullptr;
        if (!run) return out;
        attempt(row, "features", [&] { add_points(out, *run, classes); });
        attempt(row, "motions", [&] { add_motions(out, row, *run, classes); });
        return out;
    }

    /// Places of the rows of its comparison, itself among them; none where it is of no comparison, or of one that no page can show.
    std::vector<std::size_t> compared_with(const MeasuredRow& row) const {
        if (!row.comparison) return {};
        const auto& sides = sides_.at(*row.comparison);
        return sides.size() > most_sides ? std::vector<std::size_t>() : sides;
    }

    /// What cannot be read is told of, and the rest goes on.
    template <typename Work>
    void attempt(const MeasuredRow& row, const char* what, Work work) {
        try {
            work();
        } catch (const std::exception& error) {
            measured_.notices.push_back(fmt::format("{}: no {} to show: {}", row.name, what, error.what()));
        }
    }

    void add_curves(Json& out, const MeasuredRow& row, const MeasuredRun& run) {
        const auto add = [&](const char* what, const std::filesystem::path& folder, const char* whole) {
            attempt(row, "curves", [&] {
                const auto curves = read_curves(folder);
                out[what] = curve_charts(curves.epochs, whole);
                if (!curves.fault.empty())
                    measured_.notices.push_back(
                        fmt::format("{}: {}; its curves are without that", row.name, curves.fault));
            });
        };
        add("generator", run.run, "generated motions");
        add("recogniser", run.recogniser, "recogniser");
    }

    static Json points_json(const Points& points, const Classes& classes) {
        std::vector<std::int16_t> xy;
        std::vector<std::uint16_t> labels;
        for (std::size_t i = 0; i < points.labels.size(); ++i)
            if (const auto place = classes.place(points.labels[i])) {
                xy.insert(xy.end(), {points.xy[2 * i], points.xy[2 * i + 1]});
                labels.push_back(static_cast<std::uint16_t>(*place));
            }
        return {{"xy", packed(xy)}, {"labels", packed(labels)}};
    }

    void add_points(Json& out, const MeasuredRun& run, const Classes& classes) {
        const auto key = checksum_file(run.features / "real.h5");
        auto known = projections_.find(key);
        if (known == projections_.end())
            known =
                projections_.emplace(key, Projection(eval::read_features(run.features / "real.h5").samples))
                    .first;
        const auto& projection = known->second;
        const auto generated = projection.of(eval::read_features(run.features / "generated.h5").samples);
        auto real = points_json(projection.real(), classes);
        real["explained"] = projection.explained();
        out["projection"] = place_in("projections", real);
        out["points"] = points_json(generated, classes);
    }

    /// The motions of a set with their classes' places; those of unknown and left-out classes are not in it.
    Json motion_set(const std::vector<JointMotion>& motions, const Classes& classes,
                    std::uint32_t frames) const {
        Json set = Json::array();
        for (const auto& motion : motions) {
            const auto place = motion.label ? classes.place(*motion.label) : std::nullopt;
            if (!place || *place % thinning_.class_step != 0) continue;
            auto packed = packed_motion(motion, frames, thinning_.frame_step);
            packed["label"] = *place;
            set.push_back(std::move(packed));
        }
        return set;
    }

    void add_motions(Json& out, const MeasuredRow& row, const MeasuredRun& run, const Classes& classes) {
        Wanted wanted;
        wanted.per_class = thinning_.samples;
        const auto generated = gather(run.motions, wanted);
        std::uint32_t frames = 0;
        for (const auto& motion : generated) frames = std::max(frames, motion.frames);
        wanted.split = row.split;
        const auto key = fmt::format("{}|{}|{}|{}", run.dataset.string(), row.split, frames,
                                     fmt::join(classes.labels, ","));
        if (!real_.contains(key))
            real_[key] = place_in("motion_sets", motion_set(gather(run.dataset, wanted), classes, frames));
        Json motions;
        motions["topology"] = place_in("topologies", topology_json(generated.at(0).topology));
        motions["real"] = real_[key];
        motions["generated"] = place_in("motion_sets", motion_set(generated, classes, frames));
        out["motions"] = motions;
    }

    /// Its index in one of the lists; what is there already is shared.
    std::size_t place_in(const char* list, const Json& value) {
        auto& all = out_[list];
        for (std::size_t i = 0; i < all.size(); ++i)
            if (all[i] == value) return i;
        all.push_back(value);
        return all.size() - 1;
    }

    /// Of all persons; as many as two of NTU's where the dataset does not tell.
    static double joints_a_frame(const std::filesystem::path& path) {
        try {
            const ingest::Dataset dataset(path);
            return static_cast<double>(dataset.header().persons * dataset.header().topology.joints());
        } catch (const Error&) {
            return 50;
        }
    }

    /// What most_samples motions of every class of every row would add to the page, about.
    double motion_bytes() const {
        constexpr double bytes_a_joint = 3 * 2 * 4.0 / 3;
        double sum = 0;
        std::map<std::string, double>
            joints;  // of each dataset, which rows share and which takes time to open
        for (const auto& row : measured_.rows) {
            const auto* run = row.shown();
            if (!run) continue;
            const auto path = run->dataset.string();
            if (!joints.contains(path)) joints[path] = joints_a_frame(run->dataset);
            sum += static_cast<double>(classes_of(run->scored).labels.size()) * usual_frames * joints[path] *
                   bytes_a_joint * options_.most_samples;
        }
        return 1.25 * sum;  // with the real ones, which rows share
    }

    Measured& measured_;
    DetailOptions options_;
    Thinning thinning_;
    Json out_;
    std::map<std::size_t, std::vector<std::size_t>> sides_;  ///< rows of each comparison
    std::map<std::string, Projection> projections_;
    std::map<std::string, std::size_t> real_;  ///< among the motion sets
};

}  // namespace

nlohmann::ordered_json details(Measured& measured, const DetailOptions& options) {
    return Details(measured, options).all();
}

}  // namespace actformer::reports
