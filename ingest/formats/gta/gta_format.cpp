#include "ingest/formats/gta/gta_format.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/text/counted.hpp"
#include "base/text/printable.hpp"
#include "ingest/formats/detections.hpp"
#include "ingest/formats/gta/jta_file.hpp"

namespace actformer::ingest {
namespace {

constexpr double longest_limb = 1.01;           // of a unit vector
constexpr double off_unit = 0.05;               // of most limbs' lengths, at most
constexpr double farthest_apart = 4;            // metres between persons who fight
constexpr std::uint64_t most_bodies = 1 << 18;  // of a clip, over all frames
constexpr std::size_t body = gta_joints * 3;

struct GtaClip : RawClip {
    /// A person: a limb for every joint, in metres, where the person was seen.
    struct Person {
        std::vector<float> times;
        std::vector<float> limbs;  ///< (times, 22, 3): the root's position, and vectors from the parent
    };
    std::uint32_t frames = 0;
    std::vector<Person> persons;
    bool usual_lengths = false;  ///< its limbs were told by their directions alone

    std::size_t bytes() const override {
        std::size_t all = sizeof *this;
        for (const auto& person : persons) all += sizeof(float) * (person.times.size() + person.limbs.size());
        return all;
    }
};

using Place = std::array<double, 3>;

Rejection broken(std::string reason) {
    return {Rejection::Kind::broken, std::move(reason)};
}

/// Of `values` (3 * persons, 22, frames).
Place limb_at(const std::vector<float>& values, std::size_t frames, std::size_t person, std::size_t joint,
              std::size_t frame) {
    Place v;
    for (std::size_t d = 0; d < 3; ++d)
        v[d] = values[((3 * person + d) * gta_joints + joint) * frames + frame];
    return v;
}

double length_of(const Place& v) {
    return std::hypot(v[0], v[1], v[2]);
}

/// z up to y up.
Place upright(const Place& p) {
    return {p[0], p[2], -p[1]};
}

/// Why `values` (3 * persons, 22, frames) hold no unit limbs; empty where they may. A limb of length 0 has no direction, and does not count.
std::string no_unit_limbs(const std::vector<float>& values, std::uint64_t persons, std::uint64_t frames) {
    constexpr auto remedy = "joint positions? actformer ingest motions --topology gta22 takes them";
    std::uint64_t limbs = 0, unit = 0;
    for (std::size_t p = 0; p < persons; ++p)
        for (std::size_t t = 0; t < frames; ++t)
            for (std::size_t j = 1; j < gta_joints; ++j) {
                const double length = length_of(limb_at(values, frames, p, j, t));
                if (length > longest_limb)
                    return fmt::format("frame {}: joint {} is no unit vector: {}", t, j, remedy);
                limbs += length > 0;
                unit += std::abs(length - 1) <= off_unit;
            }
    if (2 * unit >= limbs) return {};
    return fmt::format("{} of {} limbs are unit vectors: {}", unit, limbs, remedy);
}

/// How far persons are apart on the floor, on average over frames and pairs; 0 for one.
double mean_distance(const GtaClip& clip) {
    double sum = 0;
    std::size_t pairs = 0;
    for (std::size_t a = 0; a < clip.persons.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            for (std::size_t t = 0; t < clip.frames; ++t, ++pairs) {
                const float *p = &clip.persons[a].limbs[t * body], *q = &clip.persons[b].limbs[t * body];
                sum += std::hypot(p[0] - q[0], p[2] - q[2]);
            }
    return pairs > 0 ? sum / static_cast<double>(pairs) : 0;
}

std::vector<float> told_lengths(const std::string& path) {
    if (path.empty()) return gta_bone_lengths();
    const hdf5::Reader file(path);
    auto lengths = file.read<float>("avglength");
    const bool sound = lengths.size() == gta_joints &&
                       std::all_of(lengths.begin(), lengths.end(), [](float x) { return x >= 0 && x < 10; });
    if (!sound) throw Error("{}: 'avglength' is no {} lengths in metres", path, gta_joints);
    lengths[0] = 0;
    return lengths;
}

/// How many persons of a file of JTA are left out, and why; empty where none is.
std::string left_out(const JtaFile& file) {
    if (file.incomplete == 0) return {};
    return fmt::format("{} left out: never seen with all of JTA's 22 joints",
                       counted(file.incomplete, "person"));
}

/// A person of JTA as limbs of GTA Combat, y up.
GtaClip::Person person_of(const JtaPerson& seen) {
    GtaClip::Person out;
    for (const auto time : seen.times) out.times.push_back(static_cast<float>(time));
    out.limbs.reserve(seen.positions.size());
    for (std::size_t i = 0; i < seen.times.size(); ++i) {
        std::array<Place, gta_joints> at{};
        for (std::size_t j = 0; j < gta_joints; ++j) {
            const double* p = &seen.positions[i * body + 3 * j];
            at[gta_joint_of_jta(j)] = {p[0], -p[1], -p[2]};
        }
        for (std::size_t j = 0; j < gta_joints; ++j)
            for (std::size_t d = 0; d < 3; ++d)
                out.limbs.push_back(static_cast<float>(
                    at[j][d] - (j == 0 ? 0 : at[static_cast<std::size_t>(gta22().parents[j])][d])));
    }
    return out;
}

}  // namespace

GtaFormat::GtaFormat(GtaOptions options)
    : options_(std::move(options)), lengths_(told_lengths(options_.lengths)) {
    if (!(options_.root_scale > 1e-3 && options_.root_scale < 1e3))
        throw Error("a root scale of {}; the public files need 5, files whose roots were not divided 1",
                    options_.root_scale);
    if (options_.persons > most_persons)
        throw Error("{} persons; give 1 to {}", options_.persons, most_persons);
    for (std::uint32_t persons = 1; persons <= most_persons; ++persons) {
        DatasetHeader header;
        header.name = fmt::format("gta-{}p", persons);
        header.topology = gta22();
        header.origin.kind = DataOrigin::Kind::synthetic;
        header.persons = persons;
        header.classes = {"combat"};
        header.fields = {"file"};
        datasets_.push_back(std::move(header));
    }
}

std::string GtaFormat::settings() const {
    return fmt::format(
        "gta: roots' x and y times {}, limbs of {} m, {}", options_.root_scale, fmt::join(lengths_, " "),
        options_.persons > 0 ? fmt::format("the {} persons seen most", options_.persons) : "all persons");
}

void GtaFormat::read(const RawText& raw, ClipSink& sink) const {
    const auto take = [&](ParsedClip clip) {
        if (auto* whole = std::get_if<std::unique_ptr<RawClip>>(&clip))
            (*whole)->fields = {printable(raw.stem)};
        sink.take(std::move(clip));
    };
    if (raw.ends_in(".json")) return take(jta_clip(raw));
    std::optional<hdf5::Reader> file;
    if (raw.on_disk)
        file.emplace(std::filesystem::path(raw.path));
    else
        file.emplace(raw.text, std::string(raw.path));
    if (file->has("avglength"))
        return take(Rejection{Rejection::Kind::dropped,
                              "lengths of limbs, and no motion: --lengths FILE takes them"});
    for (const auto& name : file->names()) {
        if (!file->is_array(name)) continue;
        auto clip = public_clip(*file, name);
        if (auto* whole = std::get_if<std::unique_ptr<RawClip>>(&clip))
            (*whole)->name = fmt::format("{}_{}", printable(raw.stem), printable(name));
        else
            std::get<Rejection>(clip).reason.insert(0, fmt::format("'{}': ", printable(name)));
        take(std::move(clip));
    }
}

ParsedClip GtaFormat::public_clip(const hdf5::Reader& file, const std::string& name) const {
    const auto shape = file.shape(name);
    if (shape.size() != 3 || shape[0] == 0 || shape[0] % 3 != 0 || shape[1] != gta_joints || shape[2] == 0)
        return broken(
            fmt::format("({}) is not (3 * persons, {}, frames)", fmt::join(shape, ", "), gta_joints));
    const std::uint64_t persons = shape[0] / 3, frames = shape[2];
    if (persons > most_persons || frames * persons > most_bodies)
        return broken(fmt::format("{} persons in {} frames, more than a clip may have", persons, frames));
    const auto values = file.read<float>(name);
    if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); }))
        return broken("a number that is not finite");
    if (auto reason = no_unit_limbs(values, persons, frames); !reason.empty())
        return broken(std::move(reason));
    auto clip = std::make_unique<GtaClip>();
    clip->dataset = persons - 1;
    clip->frames = static_cast<std::uint32_t>(frames);
    clip->usual_lengths = true;
    clip->persons.resize(persons);
    for (std::size_t p = 0; p < persons; ++p)
        for (std::size_t t = 0; t < frames; ++t) {
            auto& person = clip->persons[p];
            person.times.push_back(static_cast<float>(t));
            for (std::size_t j = 0; j < gta_joints; ++j) {
                const auto v = limb_at(values, frames, p, j, t);
                const double length = length_of(v);
                const double across = j == 0       ? options_.root_scale
                                      : length > 0 ? lengths_[j] / length
                                                   : 0,
                             up = j == 0 ? 1 : across;
                for (const auto x : upright({v[0] * across, v[1] * across, v[2] * up}))
                    person.limbs.push_back(static_cast<float>(x));
            }
        }
    if (mean_distance(*clip) > farthest_apart)
        clip->doubts.emplace_back(
            "persons over 4 m apart on average: if the file's roots were not divided by 5, say --root-scale "
            "1");
    return clip;
}

ParsedClip GtaFormat::jta_clip(const RawText& raw) const {
    if (const auto first = raw.text.find_first_not_of(" \t\r\n");
        first != std::string_view::npos && raw.text[first] == '{')
        return Rejection{Rejection::Kind::dropped, "a JSON object, and JTA's annotations are lists of rows"};
    auto parsed = read_jta(raw.text);
    if (auto* rejection = std::get_if<Rejection>(&parsed)) return std::move(*rejection);
    auto& file = std::get<JtaFile>(parsed);
    auto& persons = file.persons;
    if (persons.empty()) return broken("no person with all of JTA's 22 joints in any frame");
    const auto lost = left_out(file);
    if (options_.persons > 0) {
        if (persons.size() < options_.persons)
            return Rejection{Rejection::Kind::dropped,
                             fmt::format("{} of {} persons seen{}{}", persons.size(), options_.persons,
                                         lost.empty() ? "" : "; ", lost)};
        std::stable_sort(persons.begin(), persons.end(),
                         [](const auto& a, const auto& b) { return a.times.size() > b.times.size(); });
        persons.resize(options_.persons);
    }
    if (persons.size() > most_persons)
        return Rejection{Rejection::Kind::dropped,
                         fmt::format("{} persons, more than {}: --persons P keeps those seen most",
                                     persons.size(), most_persons)};
    if (file.frames * persons.size() > most_bodies)
        return broken(
            fmt::format("{} persons in {} frames, more than a clip may have", persons.size(), file.frames));
    auto clip = std::make_unique<GtaClip>();
    clip->name = printable(raw.stem);
    clip->dataset = persons.size() - 1;
    clip->frames = file.frames;
    bool gaps = false;
    for (const auto& person : persons) {
        gaps = gaps || person.times.size() < file.frames;
        clip->persons.push_back(person_of(person));
    }
    if (gaps) clip->doubts.emplace_back("persons not seen all the time: filled from the frames around");
    if (options_.persons == 0 && !lost.empty()) clip->doubts.push_back(lost);
    return clip;
}

kernels::CleanedBatch GtaFormat::clean(kernels::Device& device, std::size_t dataset,
                                       std::span<const std::unique_ptr<RawClip>> clips,
                                       std::vector<std::uint32_t>& frames) const {
    const auto persons = datasets_[dataset].persons;
    auto cleaned = clean_detections<GtaClip>(
        device, persons, gta_joints, clips, [](const GtaClip& clip) -> auto& { return clip.persons; },
        kernels::Smoothing{0, 0}, frames);
    auto at = cleaned.bone_length.begin();
    for (const auto& raw : clips)
        for (std::size_t p = 0; p < persons; ++p, at += gta_joints)
            if (static_cast<const GtaClip&>(*raw).usual_lengths)
                std::copy(lengths_.begin(), lengths_.end(), at);
    return cleaned;
}

}  // namespace actformer::ingest
