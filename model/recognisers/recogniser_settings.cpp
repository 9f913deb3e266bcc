#include "model/recognisers/recogniser_settings.hpp"

#include "base/error.hpp"
#include "model/train/shared_keys.hpp"

namespace actformer::model {
namespace {

using RecogniserKeys = KeyTable<RecogniserSettings>;

void add_frames_key(RecogniserKeys& table, double least) {
    table.add(&RecogniserSettings::frames,
              {.name = "frames", .meaning = "frames a window", .least = least, .most = 4096});
}

void add_network_keys(RecogniserKeys& table) {
    add_subject_keys(table);
    table
        .add(&RecogniserSettings::joints,
             {.name = "joints",
              .meaning = "own, or common15: the 15 that NTU RGB+D, GTA Combat and SMPL "
                         "share, as limbs, for FIDa across datasets",
              .choices = {"own", "common15"}})
        .add(&RecogniserSettings::width, {.name = "width",
                                          .meaning = "times the public network's 64, 128 and 256 channels",
                                          .least = 0.05,
                                          .most = 8})
        .add(&RecogniserSettings::dropout, {.name = "dropout",
                                            .meaning = "share dropped behind every temporal convolution",
                                            .least = 0,
                                            .most = 0.99});
    add_frames_key(table, 4);
}

void add_weight_decay_key(RecogniserKeys& table) {
    table.add(&RecogniserSettings::weight_decay, {.name = "weight_decay",
                                                  .meaning = "times each weight, added to its gradient",
                                                  .least = 0,
                                                  .most = 1});
}

void add_optimiser_keys(RecogniserKeys& table) {
    table
        .add(&RecogniserSettings::rate,
             {.name = "rate", .meaning = "learning rate at the start", .least = 0, .most = 100})
        .add(&RecogniserSettings::momentum,
             {.name = "momentum", .meaning = "of stochastic gradient descent", .least = 0, .most = 0.9999})
        .add(&RecogniserSettings::nesterov, {.name = "nesterov", .meaning = "Nesterov's momentum"});
    add_weight_decay_key(table);
    table.add(&RecogniserSettings::precision,
              {.name = "precision",
               .meaning = "of training: float32, or float64, which is slower and rounds next to nothing",
               .choices = {"float32", "float64"}});
}

/// Of every recogniser's training.
void add_training_keys(RecogniserKeys& table) {
    table.add(&RecogniserSettings::test_split,
              {.name = "test_split", .meaning = "clips to score after every epoch; empty scores none"});
    add_augmentation_keys(table);
    table.add(
        &RecogniserSettings::noise,
        {.name = "noise",
         .meaning =
             "standard deviation of Gaussian noise added to the training input; 0 for none, as published",
         .least = 0,
         .most = 10});
    add_trainer_keys(table);
}

const RecogniserKeys& stgcn_table() {
    static const auto all = [] {
        RecogniserKeys keys;
        add_network_keys(keys);
        add_optimiser_keys(keys);
        add_training_keys(keys);
        return keys;
    }();
    return all;
}

/// Of the GRU classifier. How the published one was trained is not known.
RecogniserSettings gru_presets() {
    RecogniserSettings presets;
    presets.kind = RecogniserKind::gru;
    presets.epochs = 200;
    presets.rate_drops = {};
    presets.rate = 0.001;
    presets.weight_decay = 0;
    return presets;
}

const RecogniserKeys& gru_table() {
    static const auto all = [] {
        RecogniserKeys keys(gru_presets());
        add_subject_keys(keys);
        add_frames_key(keys, 1);
        keys.add(&RecogniserSettings::rate,
                 {.name = "rate", .meaning = "learning rate of Adam at the start", .least = 0, .most = 100});
        add_weight_decay_key(keys);
        add_training_keys(keys);
        return keys;
    }();
    return all;
}

void check_motions(const RecogniserSettings& settings, std::uint32_t persons, std::size_t classes,
                   const std::string& dataset) {
    check_subject_counts({settings.persons, settings.classes}, {persons, static_cast<std::uint32_t>(classes)},
                         dataset);
    if (classes < 2)
        throw Error("{}: {} class{}; telling classes apart needs at least 2", dataset, classes,
                    classes == 1 ? "" : "es");
}

}  // namespace

Config recogniser_config(RecogniserKind kind) {
    return kind == RecogniserKind::gru ? Config("gru", gru_table().keys())
                                       : Config("recogniser", stgcn_table().keys(), {"stgcn"});
}

RecogniserKind recogniser_kind_in(const std::filesystem::path& file) {
    const auto named = model_named_in(file);
    if (named.empty()) return RecogniserKind::stgcn;
    if (const auto kind = eval::recogniser_kind_named(named)) return *kind;
    throw Error("{}: a configuration for model '{}', and a recogniser's is 'recogniser' or 'gru'",
                file.string(), named);
}

RecogniserSettings recogniser_settings(const Config& config) {
    const bool gru = eval::recogniser_kind_named(config.model()) == RecogniserKind::gru;
    return (gru ? gru_table() : stgcn_table()).read(config);
}

StgcnSettings stgcn_for(const RecogniserSettings& settings, ingest::Representation representation,
                        const ingest::Topology& topology, std::uint32_t persons, std::size_t classes,
                        const std::string& dataset) {
    check_motions(settings, persons, classes, dataset);
    StgcnSettings network;
    network.representation = representation;
    network.channels = representation.numbers() * persons;
    network.classes = static_cast<std::uint32_t>(classes);
    network.graph = eval::recogniser_graph(representation.node_parents(topology));
    network.width = settings.width;
    network.dropout = settings.dropout;
    return network;
}

GruSettings gru_for(const RecogniserSettings& settings, ingest::Representation representation,
                    const ingest::Topology& topology, std::uint32_t persons, std::size_t classes,
                    const std::string& dataset) {
    check_motions(settings, persons, classes, dataset);
    return {representation.numbers() * persons, static_cast<std::uint32_t>(classes),
            representation.node_parents(topology), representation};
}

}  // namespace actformer::model
