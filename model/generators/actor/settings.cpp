#include "model/generators/actor/settings.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "model/generators/generator_settings.hpp"
#include "model/train/shared_keys.hpp"

namespace actformer::model {
namespace {

constexpr double published_batch = 20;  // whose sum of divergences the published weight is for

/// `persons` and `classes` are what a configuration says, 0 where it leaves them to the dataset.
struct Settings : ActorSettings, ActorTraining {
    Settings() { persons = 0; }
};

void add_network_keys(KeyTable<Settings>& keys) {
    add_subject_keys(keys);
    keys.add(&Settings::frames, {.name = "frames",
                                 .meaning = "frames a window; motions of other lengths can be generated too",
                                 .least = 2,
                                 .most = most_actor_frames})
        .add(&Settings::width, {.name = "width",
                                .meaning = "numbers a token, and of the latent vector",
                                .least = 2,
                                .most = 8192})
        .add(&Settings::heads,
             {.name = "heads", .meaning = "of attention; they divide the width", .least = 1, .most = 1024})
        .add(&Settings::layers,
             {.name = "layers", .meaning = "of the encoder, and of the decoder", .least = 1, .most = 64})
        .add(&Settings::hidden,
             {.name = "hidden", .meaning = "inner width of a layer", .least = 1, .most = 65536})
        .add(&Settings::dropout,
             {.name = "dropout", .meaning = "share of numbers dropped in training", .least = 0, .most = 0.9});
}

void add_training_keys(KeyTable<Settings>& keys) {
    keys.add(&Settings::rate, {.name = "rate", .meaning = "learning rate of AdamW", .least = 0, .most = 1})
        .add(&Settings::weight_decay,
             {.name = "weight_decay",
              .meaning = "of AdamW: what a step takes of every weight, times the rate",
              .least = 0,
              .most = 1})
        .add(&Settings::kl_weight, {.name = "kl_weight",
                                    .meaning = "of the divergence, summed over 20 motions",
                                    .least = 0,
                                    .most = 1000})
        .add(&Settings::points, {.name = "rcxyz",
                                 .meaning = "loss of positions: joints turned by the rotations; auto: where "
                                            "motions are rotations",
                                 .choices = {"auto", "joints", "none"}});
    add_padding_key(keys);
    add_ema_key(keys);
}

const KeyTable<Settings>& table() {
    static const auto all = [] {
        KeyTable<Settings> keys;
        add_network_keys(keys);
        add_training_keys(keys);
        return keys;
    }();
    return all;
}

bool are_rotations(const MotionSpec& spec) {
    return spec.representation.finish() == ingest::Finish::orthonormal;
}

void check(const ActorSettings& s) {
    if (s.nodes < 2 || s.persons == 0 || s.classes == 0)
        throw Error("actor: {} nodes, {} persons and {} classes are too few", s.nodes, s.persons, s.classes);
    if (s.width % s.heads != 0)
        throw Error("actor: heads: {} do not divide width: {}; as in width: {}", s.heads, s.width,
                    std::max(1U, s.width / s.heads) * s.heads);
    if (s.width % 2 != 0)
        throw Error("actor: width: {} is odd; positions are pairs of a sine and a cosine", s.width);
}

}  // namespace

double ActorTraining::kl_factor() const {
    return kl_weight * published_batch / batch;
}

std::vector<Key> actor_keys() {
    return table().keys();
}

ActorSettings actor_settings(const Config& config, const MotionSpec& spec) {
    check_subjects(config, spec.persons, spec.classes, spec.where);
    ActorSettings settings = table().read(config);
    settings.representation = spec.representation;
    settings.nodes = spec.nodes();
    settings.persons = spec.persons;
    settings.classes = spec.classes;
    check(settings);
    if (actor_training(config, spec).points == PointLoss::joints && !are_rotations(spec))
        throw Error("{}: rcxyz: joints is for rotations, and its motions are {}; take rcxyz: auto",
                    spec.where, spec.representation.name());
    return settings;
}

ActorTraining actor_training(const Config& config, const MotionSpec& spec) {
    ActorTraining training = table().read(config);
    training.batch = static_cast<std::uint32_t>(config.get<std::int64_t>("batch"));
    training.seed = static_cast<std::uint64_t>(config.get<std::int64_t>("seed"));
    if (training.points == PointLoss::automatic)
        training.points = are_rotations(spec) ? PointLoss::joints : PointLoss::none;
    return training;
}

}  // namespace actformer::model
