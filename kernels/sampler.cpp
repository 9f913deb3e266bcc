#include "kernels/sampler.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "kernels/sources.hpp"

namespace actformer::kernels {
namespace {

constexpr std::uint32_t most_persons = 16;  // four bits each in the kernel

cl::Kernel sampler_kernel(Device& device, const std::string& name) {
    const auto text = std::string(source("philox")) + std::string(source("sampler"));
    return device.kernel_from(text, "sampler.cl", name);
}

std::uint64_t integer_root(std::uint64_t square) {
    std::uint64_t root = 0;
    for (std::uint64_t bit = std::uint64_t{1} << 31; bit > 0; bit >>= 1)
        if ((root | bit) * (root | bit) <= square) root |= bit;
    return root;
}

std::uint32_t low(std::uint64_t value) {
    return static_cast<std::uint32_t>(value);
}
std::uint32_t high(std::uint64_t value) {
    return static_cast<std::uint32_t>(value >> 32);
}

/// What each root weighs in a window's mean; 0 where windows are not centred.
float share_of_root(const ClipTable& table, std::uint32_t window) {
    return table.centring ? 1 / (static_cast<float>(window) * static_cast<float>(table.persons)) : 0.0F;
}

void check(const ClipTable& table) {
    if (table.clips() == 0) throw Error("no clips to draw from: the view is empty");
    if (table.labels.size() != table.clips())
        throw Error("{} clips with {} labels", table.clips(), table.labels.size());
    if (table.persons < 1 || table.persons > most_persons)
        throw Error("clips of {} persons: 1 to {} can be drawn", table.persons, most_persons);
    if (const auto& moved = table.centring;
        moved && (table.numbers < 3 || moved->root >= table.nodes || moved->first > table.nodes ||
                  moved->count > table.nodes - moved->first))
        throw Error("clips of {} nodes of {} numbers have no node {} to centre, or none to {} behind it",
                    table.nodes, table.numbers, moved->root, std::uint64_t{moved->first} + moved->count);
    if (const auto none = std::find(table.frames.begin(), table.frames.end(), 0U); none != table.frames.end())
        throw Error("clip {} has no frames", none - table.frames.begin());
}

}  // namespace

std::size_t ClipStore::place() {
    check(table_);
    std::size_t total = 0;
    for (const auto frames : table_.frames) {
        first_.push_back(total);
        total += frames;
    }
    return total;
}

ClipStore::ClipStore(ClipTable table) : table_(std::move(table)) {
    memory_.resize(place() * table_.frame_values());
}

ClipStore::ClipStore(Device& device, ClipTable table) : device_(&device), table_(std::move(table)) {
    const auto total = place();
    std::vector<std::uint32_t> rows;
    for (std::size_t c = 0; c < table_.clips(); ++c)
        rows.insert(rows.end(), {low(first_[c]), table_.frames[c], table_.labels[c], 0U});
    const auto bytes = total * table_.frame_values() * sizeof(float);
    if (total > 0xFFFF'FFFFU || bytes > device.info().max_allocation)
        throw Error(
            "device {} ({}): {} frames take {} bytes and the largest buffer holds {}; choose a smaller split "
            "or another device with --device (opencl= in a training)",
            device.info().index, device.info().name, total, bytes, device.info().max_allocation);
    motion_ = Buffer<float>(device, total * table_.frame_values());
    clips_ = Buffer<std::uint32_t>(device, rows);
}

void ClipStore::load(std::size_t clip, std::span<const float> values) {
    const auto wanted = table_.frames.at(clip) * table_.frame_values();
    if (values.size() != wanted)
        throw Error("clip {}: {} values where {} are expected", clip, values.size(), wanted);
    if (!device_) {
        std::ranges::copy(
            values, memory_.begin() + static_cast<std::ptrdiff_t>(first_[clip] * table_.frame_values()));
        return;
    }
    try {
        device_->queue().enqueueWriteBuffer(motion_.memory(), CL_TRUE,
                                            first_[clip] * table_.frame_values() * sizeof(float),
                                            values.size_bytes(), values.data());
    } catch (const cl::Error& e) {
        raise(device_->info(), "copying to the device", e);
    }
}

std::span<const float> ClipStore::in_memory(std::size_t clip) const {
    const auto values = table_.frame_values();
    return std::span(memory_).subspan(first_.at(clip) * values, table_.frames[clip] * values);
}

Batch::Batch(const ClipStore& clips, std::uint32_t samples, std::uint32_t window)
    : samples_(samples), window_(window), sample_values_(clips.table().frame_values() * window) {
    if (samples == 0 || window == 0)
        throw Error("a batch of {} windows of {} frames: both must be at least 1", samples, window);
    auto* const device = clips.on_device() ? &clips.device() : nullptr;
    values_ = HostBuffer<float>(device, samples * sample_values_);
    labels_ = HostBuffer<std::uint32_t>(device, samples);
    picks_ = HostBuffer<std::uint32_t>(device, std::size_t{samples} * 2);
}

void Batch::begin(std::uint32_t filled, const ClipStore& clips) {
    if (sample_values_ != clips.table().frame_values() * window_)
        throw Error("a batch made for clips of another shape cannot be filled from these");
    unmap();
    filled_ = filled;
}

void Batch::show(std::uint32_t sample, const DrawnWindow& chosen, Padding padding, const ClipStore& clips) {
    kernels::show(clips.table(), clips.in_memory(chosen.clip), chosen, padding, window_,
                  values_.in_memory().subspan(sample * sample_values_, sample_values_));
    labels_.in_memory()[sample] = clips.table().labels[chosen.clip];
    std::ranges::copy(std::array{chosen.clip, chosen.first}, &picks_.in_memory()[std::size_t{sample} * 2]);
}

Batch::View Batch::map() {
    return {values_.map().first(filled_ * sample_values_), labels_.map().first(filled_),
            picks_.map().first(std::size_t{filled_} * 2)};
}

void Batch::unmap() {
    values_.unmap();
    labels_.unmap();
    picks_.unmap();
}

std::uint64_t class_weight(std::uint64_t clips, ClassSampling how) {
    return how == ClassSampling::plain ? clips << 16 : integer_root(clips << 32);
}

ClassTable class_table(const ClipTable& table, ClassSampling how) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    for (std::size_t c = 0; c < table.clips(); ++c)
        members[table.labels[c]].push_back(static_cast<std::uint32_t>(c));
    ClassTable classes;
    auto& [by_class, first, edge] = classes;
    for (const auto& [label, of_class] : members) {
        by_class.insert(by_class.end(), of_class.begin(), of_class.end());
        first.push_back(static_cast<std::uint32_t>(by_class.size()));
        edge.push_back((edge.empty() ? 0 : edge.back()) + class_weight(of_class.size(), how));
    }
    return classes;
}

Sampler::Sampler(const ClipStore& clips, const SamplerOptions& options)
    : clips_(&clips), options_(options), classes_(class_table(clips.table(), options.classes)) {
    if (!clips.on_device()) return;
    by_class_ = Buffer<std::uint32_t>(clips.device(), classes_.by_class);
    class_first_ = Buffer<std::uint32_t>(clips.device(), classes_.first);
    class_edge_ = Buffer<std::uint64_t>(clips.device(), classes_.edge);
}

void Sampler::draw(std::uint64_t index, Batch& into) const {
    const auto& table = clips_->table();
    into.begin(into.samples_, *clips_);
    if (!clips_->on_device()) {
        for (std::uint32_t i = 0; i < into.samples_; ++i)
            into.show(i, drawn(table, classes_, options_, index, i, into.window_), options_.padding, *clips_);
        return;
    }
    auto& device = clips_->device();
    const auto moved = table.centring.value_or(Centring{});
    launch(device, sampler_kernel(device, "draw"), {into.window_, into.samples_}, clips_->motion(),
           clips_->clips(), by_class_, class_first_, class_edge_,
           static_cast<std::uint32_t>(classes_.edge.size()), low(options_.seed), high(options_.seed),
           low(index), high(index), options_.first_sample,
           static_cast<std::uint32_t>(options_.permute_persons),
           static_cast<std::uint32_t>(options_.padding == Padding::hold), share_of_root(table, into.window_),
           into.samples_, into.window_, table.persons, table.nodes, table.numbers, moved.root, moved.first,
           moved.count, into.values_.memory(), into.labels_.memory(), into.picks_.memory());
    into.values_.begin_map();
    into.labels_.begin_map();
    into.picks_.begin_map();
}

std::vector<Window> consecutive_windows(std::span<const std::uint32_t> frames, std::uint32_t window) {
    if (window == 0) throw Error("windows of no frames: ask for at least 1");
    std::vector<Window> out;
    for (std::size_t c = 0; c < frames.size(); ++c)
        for (std::uint32_t i = 0; i < std::max(1U, frames[c] / window); ++i)
            out.push_back({static_cast<std::uint32_t>(c), i * window});
    return out;
}

WindowCutter::WindowCutter(const ClipStore& clips, const std::vector<Window>& windows)
    : clips_(&clips), windows_(windows) {
    std::vector<std::uint32_t> rows;
    for (const auto& w : windows) {
        if (w.clip >= clips.table().clips() || w.first >= clips.table().frames[w.clip])
            throw Error("a window begins at frame {} of clip {}, which is not there", w.first, w.clip);
        rows.insert(rows.end(), {w.clip, w.first});
    }
    if (clips.on_device()) on_device_ = Buffer<std::uint32_t>(clips.device(), rows);
}

void WindowCutter::cut(std::size_t first, Batch& into) const {
    const auto& table = clips_->table();
    const auto filled = first < windows() ? std::min<std::size_t>(into.samples_, windows() - first) : 0;
    into.begin(static_cast<std::uint32_t>(filled), *clips_);
    if (!clips_->on_device()) {
        for (std::uint32_t i = 0; i < filled; ++i)
            into.show(i, {windows_[first + i].clip, windows_[first + i].first}, Padding::back_and_forth,
                      *clips_);
        return;
    }
    auto& device = clips_->device();
    const auto moved = table.centring.value_or(Centring{});
    launch(device, sampler_kernel(device, "cut"), {into.window_, into.filled_}, clips_->motion(),
           clips_->clips(), on_device_, static_cast<std::uint32_t>(first), share_of_root(table, into.window_),
           into.filled_, into.window_, table.persons, table.nodes, table.numbers, moved.root, moved.first,
           moved.count, into.values_.memory(), into.labels_.memory(), into.picks_.memory());
}

}  // namespace actformer::kernels
