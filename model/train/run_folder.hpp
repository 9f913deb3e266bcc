// A training's folder: config.yaml, log.jsonl, checkpoints and weights, held by one process at a time; where it is asked for, its curves for
// TensorBoard in events.out.tfevents.actformer.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/files/lock.hpp"
#include "model/train/config.hpp"

namespace actformer::model {

class RunFolder {
  public:
    /// Opens or makes `folder`. Throws Error where it cannot be made, or another process trains there.
    explicit RunFolder(std::filesystem::path folder, bool tensorboard = false);

    const std::filesystem::path& path() const { return folder_; }
    std::filesystem::path config() const { return folder_ / "config.yaml"; }

    /// Holds the training to the settings it began with, keys that are free to change apart, and writes config.yaml. Throws
    /// Error naming what differs.
    void keep_to(const Config& config) const;

    /// Adds a line, its number and a checksum of it to log.jsonl, and its numbers to TensorBoard's file. Throws Error where it cannot be written;
    /// it is then kept, and written before the next one.
    void log(const nlohmann::ordered_json& line);

    /// Writes the lines that could not be written before, and brings log.jsonl to the disk. Throws Error.
    void sync_log();

    /// Keeps of log.jsonl the lines of the first `epochs` epochs: those after them are trained, and logged, again. TensorBoard's file is
    /// made of these lines anew. Returns a note of the lines that are damaged and therefore left out, or not there, empty where none is; the
    /// log as it was is then log.jsonl.damaged. Throws Error where a link or no regular file is there.
    std::string rewind_log(std::uint64_t epochs);

  private:
    void write_log();
    std::filesystem::path log_file() const { return folder_ / "log.jsonl"; }
    std::filesystem::path events() const { return folder_ / "events.out.tfevents.actformer"; }

    std::filesystem::path folder_;
    bool tensorboard_;
    std::size_t lines_ = 0;                     ///< of log.jsonl, with those not written yet
    std::string unwritten_, unwritten_events_;  ///< lines of log.jsonl, and their events
    std::optional<FileLock> lock_;
};

}  // namespace actformer::model
