#include "model/generators/action2motion/settings.hpp"

#include "base/error.hpp"
#include "model/generators/action2motion/chains.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/train/shared_keys.hpp"

namespace actformer::model::action2motion {
namespace {

/// Vectors of the fused cells are whole.
constexpr std::uint32_t width_step = 16;

KeyTable<Settings> network_table() {
    KeyTable<Settings> table;
    add_subject_keys(table);
    table
        .add(&Settings::frames, {.name = "frames",
                                 .meaning = "frames a window, and the most that can be generated",
                                 .least = 2,
                                 .most = 4096})
        .add(&Settings::hidden,
             {.name = "hidden", .meaning = "numbers of a GRU's state", .least = width_step, .most = 8192})
        .add(&Settings::latent,
             {.name = "latent", .meaning = "numbers of a frame's latent", .least = 1, .most = 8192})
        .add(&Settings::time_counter,
             {.name = "time_counter", .meaning = "whether the networks see how far the motion has come"})
        .add(&Settings::body,
             {.name = "body",
              .meaning = "plain: the decoder gives poses; lie: rotations along chains of bones, for one "
                         "person of limbs or positions",
              .choices = {"plain", "lie"}})
        .add(&Settings::feedback,
             {.name = "feedback",
              .meaning = "what a lie body sees of its last frame: raw (rotations, as published) or joints",
              .choices = {"raw", "joints"}});
    return table;
}

const KeyTable<Settings>& table() {
    static const auto all = [] {
        auto table = network_table();
        table
            .add(&Settings::tf_ratio, {.name = "tf_ratio",
                                       .meaning = "share of batches that are fed their own outputs, the "
                                                  "others the truth",
                                       .least = 0,
                                       .most = 1})
            .add(&Settings::lambda_kl, {.name = "lambda_kl",
                                        .meaning = "weight of the Kullback-Leibler divergence in the loss",
                                        .least = 0,
                                        .most = 1e6})
            .add(&Settings::rate, {.name = "rate", .meaning = "learning rate", .least = 0, .most = 1});
        add_adam_keys(table);
        table.add(&Settings::weight_decay, {.name = "weight_decay",
                                            .meaning = "share of a weight that joins its gradient",
                                            .least = 0,
                                            .most = 1});
        add_padding_key(table);
        add_ema_key(table);
        return table;
    }();
    return all;
}

void check_lie(const MotionSpec& spec) {
    if (spec.persons != 1)
        throw Error("{}: {} persons a clip; body: lie is for one, body: plain takes several", spec.where,
                    spec.persons);
    if (spec.representation == ingest::Representation::rot6d)
        throw Error(
            "{}: representation rot6d; body: lie is for limbs or positions of joints, body: plain takes all",
            spec.where);
    if (!chains_of(spec.topology.parents))
        throw Error(
            "{}: its tree of {} joints has no chains; body: lie is for those of NTU RGB+D (25), SMPL (24) "
            "and "
            "NTU-13 (18), body: plain takes any",
            spec.where, spec.topology.joints());
}

}  // namespace

std::vector<Key> keys() {
    return table().keys();
}

Settings settings_of(const Config& config, const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    auto settings = table().read(config);
    if (config.has("seed")) settings.seed = static_cast<std::uint64_t>(config.get<std::int64_t>("seed"));
    if (settings.body == Body::lie) check_lie(spec);
    if (settings.hidden % width_step != 0)
        throw Error("hidden: {} is no multiple of {}; as in hidden: {}", settings.hidden, width_step,
                    settings.hidden / width_step * width_step);
    settings.persons = spec.persons;
    settings.classes = spec.classes;
    settings.representation = spec.representation;
    settings.topology = spec.topology;
    settings.bone_length = spec.bone_length;
    return settings;
}

}  // namespace actformer::model::action2motion
