#include "ingest/export/gltf/gltf_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "ingest/export/gltf/stick_figure.hpp"

namespace actformer::ingest {
namespace {

using Json = nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

// The format's numbers for what an array is of and what it is for.
constexpr int float_type = 5126, ushort_type = 5123, uint_type = 5125, vertex_buffer = 34962,
              index_buffer = 34963;

/// Colours of persons, as the pictures have them apart: blue, orange, green, red, purple, brown.
constexpr std::array<std::array<double, 3>, 6> colours{{{0.07, 0.23, 0.56},
                                                        {0.80, 0.27, 0.02},
                                                        {0.05, 0.38, 0.10},
                                                        {0.60, 0.03, 0.05},
                                                        {0.30, 0.12, 0.50},
                                                        {0.25, 0.12, 0.08}}};

struct Kind {
    const char* name;
    std::size_t numbers;
};
constexpr Kind scalar{"SCALAR", 1}, vec3{"VEC3", 3}, vec4{"VEC4", 4}, mat4{"MAT4", 16};

/// The parts of the JSON and the bytes they point into.
class Scene {
  public:
    /// `figure`, where there is one, is the body of every person.
    Scene(const std::string& name, const SkinFigure* figure) : name_(printable(name)), figure_(figure) {
        for (const char* list : {"nodes", "meshes", "materials", "skins", "accessors", "bufferViews"})
            json_[list] = Json::array();
    }

    /// `prefix` tells the person's nodes from others'.
    void add(const SkeletonMotion& motion, std::size_t person, const std::string& prefix, int times) {
        const auto top = json_["nodes"].size(), first = top + 1;
        json_["nodes"].push_back({{"name", prefix + "skeleton"}, {"children", {first}}});
        add_joints(motion, prefix);
        roots_.push_back(top);
        roots_.push_back(json_["nodes"].size());
        json_["nodes"].push_back({{"name", prefix + "body"},
                                  {"mesh", add_mesh(motion, person, prefix)},
                                  {"skin", add_skin(motion, first, prefix)}});
        add_channels(motion, first, times);
    }

    int add_times(std::uint32_t frames, double fps) {
        std::vector<float> times(frames);
        for (std::uint32_t t = 0; t < frames; ++t) times[t] = static_cast<float>(t / fps);
        return add_array(times, scalar, true);
    }

    std::string bytes() {
        Json all{{"asset", {{"version", "2.0"}, {"generator", "actformer " ACTFORMER_VERSION}}},
                 {"scene", 0},
                 {"scenes", Json::array({{{"name", name_}, {"nodes", roots_}}})}};
        all.update(json_);
        all["animations"] =
            Json::array({{{"name", name_}, {"channels", channels_}, {"samplers", samplers_}}});
        all["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
        return chunks(all.dump());
    }

  private:
    void add_joints(const SkeletonMotion& motion, const std::string& prefix) {
        const auto first = json_["nodes"].size();
        for (std::size_t j = 0; j < motion.joints(); ++j) {
            const auto& place = j == 0 ? motion.place(0, 0) : motion.rest[j];
            json_["nodes"].push_back(
                {{"name", prefix + printable(motion.topology.names[j])}, {"translation", floats(place)}});
        }
        for (std::size_t j = 1; j < motion.joints(); ++j)
            json_["nodes"][first + static_cast<std::size_t>(motion.topology.parents[j])]["children"]
                .push_back(first + j);
    }

    std::size_t add_mesh(const SkeletonMotion& motion, std::size_t person, const std::string& prefix) {
        // A body that all persons have is written once.
        if (!figure_ || shared_.empty()) shared_ = primitive(figure_ ? *figure_ : stick_figure(motion));
        const auto* what = figure_ ? "body" : "bones";
        const auto& colour = colours[person % colours.size()];
        json_["materials"].push_back({{"name", prefix + what},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {colour[0], colour[1], colour[2], 1}},
                                        {"metallicFactor", 0},
                                        {"roughnessFactor", 0.8}}}});
        auto own = shared_;
        own["material"] = json_["materials"].size() - 1;
        json_["meshes"].push_back({{"name", prefix + what}, {"primitives", Json::array({own})}});
        return json_["meshes"].size() - 1;
    }

    Json primitive(const SkinFigure& figure) {
        Json out{{"attributes",
                  {{"POSITION", add_array(figure.positions, vec3, true, vertex_buffer)},
                   {"NORMAL", add_array(figure.normals, vec3, false, vertex_buffer)},
                   {"JOINTS_0", add_array(figure.joints, vec4, false, vertex_buffer)},
                   {"WEIGHTS_0", add_array(figure.weights, vec4, false, vertex_buffer)}}}};
        if (!figure.faces.empty()) out["indices"] = add_array(figure.faces, scalar, false, index_buffer);
        return out;
    }

    std::size_t add_skin(const SkeletonMotion& motion, std::size_t first, const std::string& prefix) {
        std::vector<float> matrices;  // column by column
        for (const auto& p : rest_places(motion))
            for (const double v :
                 {1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -p[0], -p[1], -p[2], 1.0})
                matrices.push_back(static_cast<float>(v + 0.0));  // + 0.0: no minus before a zero
        std::vector<std::size_t> joints(motion.joints());
        for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = first + j;
        json_["skins"].push_back({{"name", prefix + "skeleton"},
                                  {"inverseBindMatrices", add_array(matrices, mat4)},
                                  {"skeleton", first},
                                  {"joints", joints}});
        return json_["skins"].size() - 1;
    }

    void add_channels(const SkeletonMotion& motion, std::size_t first, int times) {
        std::vector<bool> has_children(motion.joints(), false);
        for (std::size_t j = 1; j < motion.joints(); ++j) has_children[motion.topology.parents[j]] = true;
        std::vector<float> values;
        for (std::size_t j = 0; j < motion.joints(); ++j) {
            if (motion.slides[j]) {
                values.clear();
                for (std::size_t t = 0; t < motion.frames; ++t)
                    for (const double v : motion.place(t, j)) values.push_back(static_cast<float>(v));
                add_channel(first + j, "translation", times, add_array(values, vec3));
            }
            if (has_children[j]) {
                values.clear();
                for (std::size_t t = 0; t < motion.frames; ++t) {
                    const auto& q = motion.turn(t, j);
                    for (const double v : {q.x, q.y, q.z, q.w}) values.push_back(static_cast<float>(v));
                }
                add_channel(first + j, "rotation", times, add_array(values, vec4));
            }
        }
    }

    void add_channel(std::size_t node, const char* path, int times, int values) {
        channels_.push_back({{"sampler", samplers_.size()}, {"target", {{"node", node}, {"path", path}}}});
        samplers_.push_back({{"input", times}, {"output", values}});
    }

    template <typename T>
    int add_array(const std::vector<T>& values, const Kind& kind, bool with_range = false, int target = 0) {
        const auto size = values.size() * sizeof(T);
        Json view{{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
        if (target != 0) view["target"] = target;
        binary_.append(reinterpret_cast<const char*>(values.data()), size);  // some multiple of 4 bytes each
        Json accessor{{"bufferView", json_["bufferViews"].size()},
                      {"componentType", std::is_same_v<T, float>           ? float_type
                                        : std::is_same_v<T, std::uint16_t> ? ushort_type
                                                                           : uint_type},
                      {"count", values.size() / kind.numbers},
                      {"type", kind.name}};
        if (with_range) {
            std::vector<T> least(kind.numbers, std::numeric_limits<T>::max()),
                most(kind.numbers, std::numeric_limits<T>::lowest());
            for (std::size_t i = 0; i < values.size(); ++i) {
                least[i % kind.numbers] = std::min(least[i % kind.numbers], values[i]);
                most[i % kind.numbers] = std::max(most[i % kind.numbers], values[i]);
            }
            accessor["min"] = least;
            accessor["max"] = most;
        }
        json_["bufferViews"].push_back(std::move(view));
        json_["accessors"].push_back(std::move(accessor));
        return static_cast<int>(json_["accessors"].size()) - 1;
    }

    static std::array<float, 3> floats(const Point& p) {
        return {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])};
    }

    /// "glTF", the version and the length; then the JSON and the bytes, each behind its length and kind, filled up to fours.
    std::string chunks(std::string text) {
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
        const auto length = std::uint64_t{28} + text.size() + binary_.size();
        if (length > std::numeric_limits<std::uint32_t>::max())
            throw Error("{}: {} bytes, more than the 4 GiB that a .glb holds; export it as .npz", name_,
                        length);
        std::string out;
        const auto put = [&](std::uint64_t value) {
            const auto word = static_cast<std::uint32_t>(value);
            out.append(reinterpret_cast<const char*>(&word), sizeof word);
        };
        constexpr std::uint32_t magic = 0x46546C67, json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
        out.reserve(length);
        for (const std::uint64_t word : {std::uint64_t{magic}, std::uint64_t{2}, length,
                                         std::uint64_t{text.size()}, std::uint64_t{json_chunk}})
            put(word);
        out += text;
        put(binary_.size());
        put(binary_chunk);
        out += binary_;
        return out;
    }

    std::string name_;
    const SkinFigure* figure_;
    Json shared_;  ///< the primitive of the figure added last
    Json json_ = Json::object(), channels_ = Json::array(), samplers_ = Json::array();
    std::vector<std::size_t> roots_;
    std::string binary_;
};

}  // namespace

std::string glb_bytes(std::span<const SkeletonMotion> persons, double fps, const std::string& name,
                      const SkinFigure* figure) {
    Scene scene(name, figure);
    const int times = scene.add_times(persons[0].frames, fps);
    for (std::size_t p = 0; p < persons.size(); ++p)
        scene.add(persons[p], p, persons.size() > 1 ? fmt::format("p{} ", p + 1) : "", times);
    return scene.bytes();
}

}  // namespace actformer::ingest
