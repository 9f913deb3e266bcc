#include "model/generators/csgn/settings.hpp"

#include "base/error.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/train/shared_keys.hpp"

namespace actformer::model {
namespace {

const KeyTable<CsgnSettings>& table() {
    static const auto all = [] {
        using Settings = CsgnSettings;
        KeyTable<Settings> keys;
        add_subject_keys(keys);
        keys.add(&Settings::frames, {.name = "frames",
                                     .meaning = "frames a window, and the most that can be generated",
                                     .least = csgn_fewest_frames,
                                     .most = 4096})
            .add(&Settings::width, {.name = "width",
                                    .meaning = "channels of the generator's finest level",
                                    .least = 1,
                                    .most = 1024})
            .add(&Settings::d_width, {.name = "d_width",
                                      .meaning = "channels of the discriminator's first layer",
                                      .least = 1,
                                      .most = 1024})
            .add(&Settings::latent,
                 {.name = "latent", .meaning = "channels of the prior", .least = 1, .most = 8192})
            .add(&Settings::length_scale,
                 {.name = "length_scale",
                  .meaning = "latent frames (16 frames each), of the last channel's process",
                  .least = 0.001,
                  .most = 1e6})
            .add(&Settings::partition,
                 {.name = "partition",
                  .meaning = "neighbours' weights: radial (inward, outward) or none (one for all)",
                  .choices = {"radial", "none"}});
        return keys;
    }();
    return all;
}

}  // namespace

PriorSettings CsgnSettings::prior() const {
    PriorSettings prior;
    prior.channels = latent;
    prior.length_scale = length_scale;
    prior.root = PriorRoot::symmetric;
    return prior;
}

std::vector<Key> csgn_keys() {
    return table().keys();
}

CsgnSettings csgn_settings(const Config& config, const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    auto settings = table().read(config);
    settings.persons = spec.persons;
    settings.classes = spec.classes;
    settings.parents = spec.representation.node_parents(spec.topology);
    settings.representation = spec.representation;
    return checked(std::move(settings));
}

CsgnSettings checked(CsgnSettings s) {
    if (s.nodes() < 2 || s.persons == 0 || s.classes == 0)
        throw Error("csgn: {} nodes, {} persons and {} classes are too few", s.nodes(), s.persons, s.classes);
    if (s.width == 0 || s.d_width == 0 || s.latent == 0)
        throw Error("csgn: width, d_width and latent must not be 0");
    if (s.frames < csgn_fewest_frames)
        throw Error("csgn: {} frames, but the discriminator halves them four times and needs at least {}",
                    s.frames, csgn_fewest_frames);
    if (!(s.length_scale > 0)) throw Error("csgn: length_scale must be above 0 latent frames");
    return s;
}

}  // namespace actformer::model
