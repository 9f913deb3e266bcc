#include "ingest/formats/nturecon/nturecon_format.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/pickle/pickle.hpp"
#include "ingest/formats/ntu/actions.hpp"
#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/ntu/ntu_format.hpp"
#include "ingest/formats/parsed.hpp"
#include "ingest/formats/rotational/pose_rows.hpp"

namespace actformer::ingest {
namespace {

constexpr std::string_view body_mark = "_body";

struct ReconName {
    std::string clip;
    NtuName ntu;
    std::string body;
};

/// Of SsssCcccPpppRrrrAaaa_bodyK.
std::optional<ReconName> parse_name(std::string_view stem) {
    const auto mark = stem.rfind(body_mark);
    if (mark == std::string_view::npos) return {};
    const auto ntu = parse_ntu_name(stem.substr(0, mark));
    const auto body = stem.substr(mark + body_mark.size());
    if (!ntu || body.empty() || body.find_first_not_of("0123456789") != std::string_view::npos) return {};
    return ReconName{std::string(stem.substr(0, mark)), *ntu, std::string(body)};
}

/// The files' unit a metre.
double scaling_of(const PickleValue& file) {
    const auto value = file.get("smpl_scaling");
    double scaling = 0;
    if (value.is_array()) {
        const auto& array = value.array();
        if (array.numbers() && array.elements() == 1) scaling = array.all_numbers()[0];
    } else {
        scaling = value.real();
    }
    if (!(scaling > 0) || !std::isfinite(scaling)) throw Error("'smpl_scaling' is no positive number");
    return scaling;
}

/// Metres, y up: AIST++'s fits to NTU have y down.
RotationalMotion upright(const PickleValue& file) {
    const auto poses = smpl_poses(file.get("smpl_poses").array(), "smpl_poses");
    const NumpyRows translations(file.get("smpl_trans").array(), "smpl_trans", {3});
    if (translations.count() != poses.count())
        throw Error("{} frames of 'smpl_poses' and {} of 'smpl_trans'", poses.count(), translations.count());
    const double scaling = scaling_of(file);
    auto motion = motion_of(poses, [&](std::uint64_t frame, double* xyz) {
        translations.read(frame, xyz);
        for (std::size_t d = 0; d < 3; ++d) xyz[d] /= scaling;
    });
    turn(motion, y_down_to_y_up);
    return motion;
}

}  // namespace

NtuReconFormat::NtuReconFormat(const std::string& dataset, RotationalTarget target)
    : target_(std::move(target)), datasets_{target_.header(dataset)} {
    auto& header = datasets_[0];
    header.fields = ntu_fields();
    header.classes = ntu::class_names(1);
    for (auto& split : ntu_splits())
        if (split.name.starts_with("xsub/")) header.splits.push_back(std::move(split));
}

std::optional<Rejection> NtuReconFormat::refuse(const RawText& raw) const {
    const auto name = parse_name(raw.stem);
    if (!name)
        return Rejection{Rejection::Kind::broken,
                         "the name is not SsssCcccPpppRrrrAaaa_bodyK with an action from 001 to 120"};
    if (ntu::two_persons(name->ntu.action))
        return Rejection{Rejection::Kind::dropped,
                         fmt::format("action {} is of two persons", name->ntu.action)};
    if (name->body != "0")
        return Rejection{Rejection::Kind::dropped,
                         fmt::format("body {} of an action of one person", name->body)};
    return {};
}

void NtuReconFormat::read(const RawText& raw, ClipSink& sink) const {
    sink.take(made_or_broken("", [&]() -> ParsedClip {
        const auto name = parse_name(raw.stem);
        const Pickle file(raw.text);
        auto clip = whole(upright(file.root()), target_);
        clip->name = name->clip;
        clip->label = ntu::label_of(name->ntu.action);
        clip->fields = ntu_fields_of(name->ntu);
        return clip;
    }));
}

}  // namespace actformer::ingest
