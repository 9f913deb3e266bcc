#include "ingest/smpl/body_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/files/mapped_file.hpp"
#include "base/text/html.hpp"
#include "base/text/printable.hpp"
#include "ingest/smpl/model_arrays.hpp"

namespace actformer::ingest {
namespace {

constexpr const char* remedy =
    "SMPL's own files, as SMPL_NEUTRAL.pkl or basicmodel_neutral_lbs_10_207_0_v1.1.0.pkl, have them";
constexpr std::uint64_t pose_features = 9 * (smpl_joints - 1);

/// The arrays of a file, each asked for with the shape that it must have; 0 stands for any length.
class Arrays {
  public:
    explicit Arrays(ModelArrays arrays) : arrays_(std::move(arrays)) {}

    const ModelArray& get(const std::string& key, const std::vector<std::uint64_t>& shape) const {
        const auto found = arrays_.find(key);
        if (found == arrays_.end())
            throw Error("no '{}' in it, so that it is no body model; {}", key, remedy);
        const auto& array = found->second;
        bool fits = array.shape.size() == shape.size();
        for (std::size_t d = 0; fits && d < shape.size(); ++d)
            fits = array.shape[d] > 0 && (shape[d] == 0 || array.shape[d] == shape[d]);
        if (!fits)
            throw Error("'{}' is {}, where {} is meant; {}", key, array.shape_text(), text(shape), remedy);
        for (std::size_t i = 0; i < array.values.size(); ++i)
            if (!std::isfinite(array.values[i]))
                throw Error("'{}' holds {} as its number {}: damaged", key, array.values[i], i + 1);
        return array;
    }

  private:
    static std::string text(const std::vector<std::uint64_t>& shape) {
        std::string out;
        for (const auto n : shape) out += (out.empty() ? "(" : ", ") + (n ? std::to_string(n) : "any");
        return out + ")";
    }

    ModelArrays arrays_;
};

const char* model_of(std::uint64_t joints) {
    switch (joints) {
        case 5:
            return ", as FLAME has";
        case 16:
            return ", as MANO has";
        case 52:
            return ", as SMPL+H has";
        case 55:
            return ", as SMPL-X has";
        default:
            return "";
    }
}

/// Refuses every tree but SMPL's.
void check_joints(const Arrays& arrays) {
    const auto& table = arrays.get("kintree_table", {2, 0});
    const auto joints = table.shape[1];
    if (joints != smpl_joints)
        throw Error("a body model of {} joints{}, where SMPL's {} are meant; {}", joints, model_of(joints),
                    smpl_joints, remedy);
    for (std::size_t k = 0; k < joints; ++k) {
        // -1 is the root's parent; files that count in 32 bits without a sign have 4294967295.
        const double parent =
            table.values[k] >= std::numeric_limits<std::uint32_t>::max() ? -1 : table.values[k];
        if (parent != smpl24_parents[k])
            throw Error("joint {} hangs on {}, where SMPL's hangs on {}: a model of other joints; {}", k,
                        parent, smpl24_parents[k], remedy);
        if (table.values[joints + k] != static_cast<double>(k))
            throw Error("'kintree_table' numbers joint {} as {}; {}", k, table.values[joints + k], remedy);
    }
}

std::vector<float> floats(const ModelArray& array) {
    return {array.values.begin(), array.values.end()};
}

/// (V, 3, B) to (B, V, 3).
std::vector<double> shapes_first(const ModelArray& directions) {
    const auto shapes = directions.shape[2], coordinates = directions.values.size() / shapes;
    std::vector<double> out(directions.values.size());
    for (std::size_t i = 0; i < coordinates; ++i)
        for (std::size_t b = 0; b < shapes; ++b) out[b * coordinates + i] = directions.values[i * shapes + b];
    return out;
}

/// J = regressor (24, V) times places (V, 3), which it is linear in: the joints of a sum are the sum of the joints.
std::vector<double> regressed(const ModelArray& regressor, std::span<const double> places) {
    const auto vertices = regressor.shape[1];
    std::vector<double> out(smpl_joints * 3, 0);
    for (std::size_t k = 0; k < smpl_joints; ++k)
        for (std::size_t v = 0; v < vertices; ++v)
            if (const double share = regressor.values[k * vertices + v]; share != 0)
                for (std::size_t d = 0; d < 3; ++d) out[3 * k + d] += share * places[3 * v + d];
    return out;
}

void take_joints(const Arrays& arrays, const ModelArray& rest, const std::vector<double>& shapes,
                 kernels::RestJoints& joints) {
    const auto& regressor = arrays.get("J_regressor", {smpl_joints, rest.shape[0]});
    joints.parents.assign(smpl24_parents.begin(), smpl24_parents.end());
    joints.places = regressed(regressor, rest.values);
    for (std::size_t b = 0; b < shapes.size() / rest.values.size(); ++b) {
        const auto moved =
            regressed(regressor, std::span(shapes).subspan(b * rest.values.size(), rest.values.size()));
        joints.shapes.insert(joints.shapes.end(), moved.begin(), moved.end());
    }
}

void take_weights(const ModelArray& weights, kernels::SkinnedBody& skin) {
    skin.first.push_back(0);
    for (std::size_t v = 0; v < weights.shape[0]; ++v) {
        double sum = 0;
        for (std::uint32_t k = 0; k < smpl_joints; ++k) {
            const double share = weights.values[v * smpl_joints + k];
            if (share < 0) throw Error("'weights' moves vertex {} by {} of joint {}: damaged", v, share, k);
            sum += share;
            if (share > 0) skin.influences.push_back({k, static_cast<float>(share)});
        }
        if (std::fabs(sum - 1) > 0.01)
            throw Error("'weights' of vertex {} add up to {}, not to 1: damaged", v, sum);
        skin.first.push_back(static_cast<std::uint32_t>(skin.influences.size()));
    }
}

std::vector<std::uint32_t> faces_of(const ModelArray& faces, std::uint64_t vertices) {
    std::vector<std::uint32_t> out;
    for (const double v : faces.values) {
        if (v < 0 || v >= static_cast<double>(vertices) || v != std::floor(v))
            throw Error("'f' has a face at vertex {} of {}: damaged", v, vertices);
        out.push_back(static_cast<std::uint32_t>(v));
    }
    return out;
}

ModelArrays arrays_of(std::string_view bytes) {
    if (is_html(bytes)) throw Error("{}", html_in_place_of("a body model"));
    const std::vector<std::string> wanted{"v_template", "shapedirs",     "posedirs", "J_regressor",
                                          "weights",    "kintree_table", "f"};
    try {
        return bytes.starts_with("PK") ? read_model_npz(bytes, wanted) : read_model_pickle(bytes, wanted);
    } catch (const Error& e) {
        throw Error("{}; take SMPL's .pkl as it is downloaded from smpl.is.tue.mpg.de", e.what());
    }
}

}  // namespace

RestSkeleton SmplBody::rest(std::span<const float> betas) const {
    auto places = skin.joints.shaped(betas);
    for (std::size_t k = smpl_joints - 1; k > 0; --k)  // parents come first
        for (std::size_t d = 0; d < 3; ++d)
            places[3 * k + d] -= places[3 * static_cast<std::size_t>(smpl24_parents[k]) + d];
    return {places, name};
}

SmplBody parse_smpl_body(std::string_view bytes, const std::string& name) {
    const Arrays arrays(arrays_of(bytes));
    check_joints(arrays);
    const auto& rest = arrays.get("v_template", {0, 3});
    const auto vertices = rest.shape[0];
    const auto shapes = shapes_first(arrays.get("shapedirs", {vertices, 3, 0}));
    SmplBody body;
    body.name = name;
    body.skin.rest = floats(rest);
    body.skin.shapes.assign(shapes.begin(), shapes.end());
    body.skin.pose_directions = floats(arrays.get("posedirs", {vertices, 3, pose_features}));
    take_joints(arrays, rest, shapes, body.skin.joints);
    take_weights(arrays.get("weights", {vertices, smpl_joints}), body.skin);
    body.faces = faces_of(arrays.get("f", {0, 3}), vertices);
    return body;
}

SmplBody read_smpl_body(const std::filesystem::path& file) {
    const MappedFile mapped(file);
    try {
        return parse_smpl_body(mapped.text(), printable(file.filename().string()));
    } catch (const Error& e) {
        throw Error("{}: {}", file.string(), e.what());
    }
}

void check_takes_body(const BodyModel& motions, const std::string& where) {
    if (motions.representation != Representation::rot6d ||
        !std::ranges::equal(motions.topology.parents, smpl24_parents))
        throw Error(
            "{}: motions are {} of {} joints, where a body model takes rot6d of SMPL's {}; leave --body out",
            where, motions.representation.name(), motions.topology.joints(), smpl_joints);
}

}  // namespace actformer::ingest
