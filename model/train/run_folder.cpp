#include "model/train/run_folder.hpp"

#include <chrono>
#include <fstream>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"
#include "model/train/tensorboard.hpp"

namespace actformer::model {
namespace {

/// Seconds since 1970.
double now() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

RunFolder::RunFolder(std::filesystem::path folder, bool tensorboard)
    : folder_(std::move(folder)), tensorboard_(tensorboard) {
    make_folders(folder_);
    lock_ = FileLock::if_free(folder_ / "lock");
    if (!lock_)
        throw Error("{}: another training is writing there; wait for it, or choose another -o",
                    folder_.string());
}

void RunFolder::keep_to(const Config& config) const {
    if (std::filesystem::exists(this->config())) {
        if (const auto model = model_named_in(this->config()); model != config.model())
            throw Error("{}: holds a training of {}, not of '{}'; choose another -o", folder_.string(),
                        in_quotes(model), config.model());
        auto before = config.blank();
        before.load(this->config());
        const auto differences = config.differences(before);
        if (!differences.empty())
            throw Error("{}: holds a training with other settings ({}); choose another -o", folder_.string(),
                        fmt::join(differences, ", "));
    }
    write_whole(this->config(), config.yaml());
}

void RunFolder::log(const nlohmann::ordered_json& line) const {
    append(folder_ / "log.jsonl", line.dump() + "\n");
    if (!tensorboard_) return;
    if (const auto event = tensorboard_event(line, now()); !event.empty()) append(events(), event);
}

void RunFolder::rewind_log(std::uint64_t epochs) const {
    const auto path = folder_ / "log.jsonl";
    std::ifstream file(path, std::ios::binary);
    std::string kept, line, curves = tensorboard_head(now());
    while (std::getline(file, line) && !file.eof()) {
        const auto json = json_or_discarded<nlohmann::ordered_json>(line);
        if (json.is_object() && json.contains("epoch") && json["epoch"].is_number_unsigned() &&
            json["epoch"] <= epochs) {
            kept += line + "\n";
            if (tensorboard_) curves += tensorboard_event(json, now());
        }
    }
    if (file.is_open()) {
        file.close();
        write_whole(path, kept);
    }
    if (tensorboard_) write_whole(events(), curves);
}

}  // namespace actformer::model
