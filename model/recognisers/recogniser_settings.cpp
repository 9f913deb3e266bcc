#include "model/recognisers/recogniser_settings.hpp"

#include "base/error.hpp"
#include "model/train/rate_drops.hpp"

namespace actformer::model {

Config recogniser_config() {
    using Numbers = std::vector<std::int64_t>;
    return Config("recogniser",
                  {{"data", std::string(), "dataset folder"},
                   {"train_split", std::string("all"), "clips to train on"},
                   {"test_split", std::string(), "clips to score after every epoch; empty scores none"},
                   {"persons", std::int64_t{0}, "persons a clip; 0 takes the dataset's", 0, 16},
                   {"classes", std::int64_t{0}, "classes; 0 takes the dataset's", 0, 100000},
                   {"width", 1.0, "times the public network's 64, 128 and 256 channels", 0.05, 8},
                   {"dropout", 0.5, "share dropped behind every temporal convolution", 0, 0.99},
                   {"frames", std::int64_t{60}, "frames a window", 4, 4096},
                   {"batch", std::int64_t{64}, "windows a step", 1, 65536},
                   {"epochs", std::int64_t{80}, "times through the clips", 1, 1000000},
                   {"rate", 0.1, "learning rate at the start", 0, 100},
                   {"rate_drops", Numbers{10, 50},
                    "epochs at whose start the rate is multiplied by rate_factor", 0, 1000000},
                   {"rate_factor", 0.1, "see rate_drops", 0, 1},
                   {"momentum", 0.9, "of stochastic gradient descent", 0, 0.9999},
                   {"nesterov", true, "Nesterov's momentum"},
                   {"weight_decay", 1e-4, "times each weight, added to its gradient", 0, 1},
                   {"seed", std::int64_t{0}, "of weights, windows and dropout", 0, 9e15},
                   {"precision",
                    std::string("float32"),
                    "float32, or float64, slower, where rounding decides next to nothing",
                    std::numeric_limits<double>::lowest(),
                    std::numeric_limits<double>::max(),
                    {"float32", "float64"}},
                   {"device", std::string("cpu"), "where libtorch trains: cpu, cuda or cuda:N"},
                   {"opencl", std::string(), "OpenCL device that draws the windows; empty for the usual one"},
                   {"threads", std::int64_t{0}, "processor threads; 0 takes all", 0, 4096}});
}

RecogniserSettings recogniser_settings(const Config& config) {
    const auto text = [&](const char* key) { return config.get<std::string>(key); };
    const auto real = [&](const char* key) { return config.get<double>(key); };
    const auto whole = [&](const char* key) {
        return static_cast<std::uint32_t>(config.get<std::int64_t>(key));
    };
    RecogniserSettings s;
    s.data = text("data");
    s.train_split = text("train_split");
    s.test_split = text("test_split");
    s.persons = whole("persons");
    s.classes = whole("classes");
    s.width = real("width");
    s.dropout = real("dropout");
    s.frames = whole("frames");
    s.batch = whole("batch");
    s.epochs = whole("epochs");
    s.rate = real("rate");
    s.rate_factor = real("rate_factor");
    s.rate_drops = config.get<std::vector<std::int64_t>>("rate_drops");
    s.momentum = real("momentum");
    s.weight_decay = real("weight_decay");
    s.nesterov = config.get<bool>("nesterov");
    s.seed = static_cast<std::uint64_t>(config.get<std::int64_t>("seed"));
    s.precision = text("precision");
    s.device = text("device");
    s.opencl = text("opencl");
    s.threads = static_cast<int>(config.get<std::int64_t>("threads"));
    return s;
}

double RecogniserSettings::rate_at(std::uint64_t epoch) const {
    return rate * rate_share(rate_drops, rate_factor, epoch);
}

const std::vector<std::string>& keys_free_to_change() {
    static const std::vector<std::string> keys{"data", "epochs", "device", "opencl", "threads"};
    return keys;
}

StgcnSettings network_for(const RecogniserSettings& settings, const ingest::Topology& topology,
                          std::uint32_t persons, std::size_t classes, const std::string& dataset) {
    if (settings.persons != 0 && settings.persons != persons)
        throw Error("{}: {} person{} a clip, but the configuration says persons: {}", dataset, persons,
                    persons == 1 ? "" : "s", settings.persons);
    if (settings.classes != 0 && settings.classes != classes)
        throw Error("{}: {} classes, but the configuration says classes: {}", dataset, classes,
                    settings.classes);
    if (classes < 2)
        throw Error("{}: {} class{}; telling classes apart needs at least 2", dataset, classes,
                    classes == 1 ? "" : "es");
    StgcnSettings network;
    network.channels = 3 * persons;
    network.classes = static_cast<std::uint32_t>(classes);
    network.graph = eval::recogniser_graph(topology.parents);
    network.width = settings.width;
    network.dropout = settings.dropout;
    return network;
}

}  // namespace actformer::model
