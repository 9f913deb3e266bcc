#include "model/train/run_folder.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/text/json.hpp"

namespace actformer::model {

RunFolder::RunFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw Error("{}: the folder cannot be made or written: {}", folder_.string(), error.message());
    lock_ = FileLock::if_free(folder_ / "lock");
    if (!lock_)
        throw Error("{}: another training is writing there; wait for it, or choose another -o",
                    folder_.string());
}

void RunFolder::keep_to(const Config& config) const {
    if (std::filesystem::exists(this->config())) {
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
    const auto path = folder_ / "log.jsonl";
    std::ofstream file(path, std::ios::app | std::ios::binary);
    file << line.dump() << '\n' << std::flush;
    if (!file) throw Error("{}: cannot be written: {}", path.string(), std::strerror(errno));
}

void RunFolder::rewind_log(std::uint64_t epochs) const {
    const auto path = folder_ / "log.jsonl";
    std::ifstream file(path, std::ios::binary);
    if (!file) return;
    std::string kept, line;
    while (std::getline(file, line) && !file.eof()) {
        const auto json = json_or_discarded<nlohmann::json>(line);
        if (json.is_object() && json.contains("epoch") && json["epoch"].is_number_unsigned() &&
            json["epoch"] <= epochs)
            kept += line + "\n";
    }
    file.close();
    write_whole(path, kept);
}

}  // namespace actformer::model
