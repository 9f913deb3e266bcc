#include "eval/stgcn/tuning.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <nlohmann/json.hpp>

#include "base/checksum/checked_json.hpp"
#include "base/error.hpp"
#include "base/files/cache.hpp"
#include "base/files/file.hpp"
#include "base/text/loose_json.hpp"
#include "eval/stgcn/recogniser.hpp"
#include "kernels/buffer.hpp"

namespace actformer::eval {
namespace {

using kernels::Tiles;
using Json = nlohmann::ordered_json;

std::string key_of(const kernels::DeviceInfo& device) {
    return fmt::format("{} | {} | {}", device.name, device.platform, device.driver);
}

/// What is kept; nothing where the file is not there, or damaged.
Json read_file() {
    auto json = loose::read(tiles_file());
    if (!json.is_object() || own_checksum_of(json) == OwnChecksum::wrong) return Json::object();
    return json;
}

Json to_json(const Tiles& t) {
    return {{"vec", t.vec},
            {"rows", t.rows},
            {"vectors", t.vectors},
            {"item_tiles", t.item_tiles},
            {"group", t.group},
            {"columns_first", t.columns_first},
            {"filter_vec", t.filter_vec},
            {"sequences", t.sequences}};
}

bool sensible(const Tiles& t) {
    const auto within = [](std::uint32_t value, std::uint32_t most) { return value >= 1 && value <= most; };
    const auto vector = [&](std::uint32_t value) { return within(value, 16) && std::has_single_bit(value); };
    return vector(t.vec) && vector(t.filter_vec) && within(t.rows, 64) && within(t.vectors, 16) &&
           t.block() % t.filter_vec == 0 && within(t.item_tiles, 4096) && within(t.group, 1024) &&
           within(t.sequences, 65536);
}

/// Shapes that are worth a try: what 32 vector registers hold on a processor, some dozens of numbers on a GPU.
std::vector<Tiles> shapes_to_try(const Tiles& from, bool cpu) {
    using Shape = std::array<std::uint32_t, 3>;  // vec, rows, vectors
    const std::vector<Shape> on_cpu{{16, 5, 4}, {16, 8, 2}, {16, 4, 4}, {16, 6, 4}, {16, 10, 2}, {16, 12, 2},
                                    {8, 5, 2},  {8, 6, 2},  {8, 4, 3},  {8, 4, 2},  {4, 4, 2}};
    const std::vector<Shape> on_gpu{{4, 8, 1}, {4, 4, 1}, {4, 4, 2}, {4, 8, 2},
                                    {2, 8, 1}, {8, 8, 1}, {1, 16, 1}};
    std::vector<Tiles> out;
    for (const auto& [vec, rows, vectors] : cpu ? on_cpu : on_gpu) {
        auto tiles = from;
        tiles.vec = vec;
        tiles.rows = rows;
        tiles.vectors = vectors;
        tiles.filter_vec = cpu ? vec : from.filter_vec;
        out.push_back(tiles);
    }
    return out;
}

std::vector<Tiles> vary(const Tiles& from, std::uint32_t Tiles::*size,
                        const std::vector<std::uint32_t>& values) {
    std::vector<Tiles> out;
    for (const auto value : values) {
        out.push_back(from);
        out.back().*size = value;
    }
    return out;
}

}  // namespace

std::filesystem::path tiles_file() {
    return cache_folder() / "tiles.json";
}

Tiles load_tiles(const kernels::DeviceInfo& device) {
    const auto json = read_file();
    if (json.empty() && std::filesystem::exists(tiles_file()))
        throw Error("{}: damaged; remove it, or measure again with actformer bench features --tune",
                    tiles_file().string());
    const auto found = json.find(key_of(device));
    if (found == json.end()) return default_tiles(device);
    try {
        Tiles t;
        t.vec = found->at("vec");
        t.rows = found->at("rows");
        t.vectors = found->at("vectors");
        t.item_tiles = found->at("item_tiles");
        t.group = found->at("group");
        t.columns_first = found->at("columns_first");
        t.filter_vec = found->at("filter_vec");
        t.sequences = found->at("sequences");
        if (sensible(t)) return t;
    } catch (const Json::exception&) {  // an entry of another version
    }
    return default_tiles(device);
}

void save_tiles(const kernels::DeviceInfo& device, const Tiles& tiles) {
    auto json = read_file();
    json["program"] = "actformer " ACTFORMER_VERSION;
    json[key_of(device)] = to_json(tiles);
    make_folders(tiles_file().parent_path());
    write_whole(tiles_file(), with_checksum(json).dump(2) + "\n");
}

double measure_rate(kernels::Device& device, const StgcnWeights& weights, const Tiles& tiles,
                    std::uint32_t sequences, std::uint32_t frames, int repeats) {
    StgcnRecogniser recogniser(device, weights, tiles);
    const std::vector<float> motions(std::size_t{sequences} * weights.channels * frames * weights.joints(),
                                     0.5F);
    const kernels::Buffer<float> on_device(device, motions);
    double best = 0;
    for (int i = 0; i <= repeats; ++i) {  // the first run builds kernels and makes room
        const auto start = std::chrono::steady_clock::now();
        recogniser.recognise(on_device.memory(), sequences, frames);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (i > 0) best = std::max(best, sequences / seconds);
    }
    return best;
}

Tiles tune(kernels::Device& device, const StgcnWeights& weights, std::uint32_t sequences,
           std::uint32_t frames, const std::function<void(const Tiles&, double)>& tell) {
    auto best = default_tiles(device.info());
    double best_rate = 0;
    const auto try_all = [&](const std::vector<Tiles>& choices) {
        for (const auto& tiles : choices) {
            double rate = 0;
            try {
                rate = measure_rate(device, weights, tiles, sequences, frames, 3);
            } catch (const Error&) {  // more registers or memory than the device has
            }
            tell(tiles, rate);
            if (rate > best_rate) best_rate = rate, best = tiles;
        }
    };
    const bool cpu = device.info().type == "CPU";
    try_all(shapes_to_try(best, cpu));
    try_all(vary(best, &Tiles::item_tiles,
                 cpu ? std::vector<std::uint32_t>{4, 8, 32, 64} : std::vector<std::uint32_t>{2, 4}));
    if (!cpu) try_all(vary(best, &Tiles::group, {32, 128, 256}));
    try_all(vary(best, &Tiles::filter_vec,
                 cpu ? std::vector<std::uint32_t>{8} : std::vector<std::uint32_t>{2, 4}));
    try_all(vary(best, &Tiles::sequences, {2, 4, 8, 16, 32, 64}));
    return best;
}

}  // namespace actformer::eval
