// Options that several commands have, and the refusal of those without effect.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

namespace actformer::cli {

/// --device: where OpenCL computes (kernels/device.hpp).
void add_device_option(CLI::App* command, std::string& device);

/// --force: an output may take the place of a file of others (ingest/export/foreign.hpp).
void add_force_option(CLI::App* command, bool& force);

/// A check of a file's name: one that ends as files of another kind do, as in `generate -o motions.gif`, is refused. `ending` with its dot.
std::function<std::string(const std::string&)> ends_in(const std::string& ending);

/// As CLI::Range, but NaN is refused.
CLI::Validator number_in(double least, double most);

/// Words KEY=VALUE that override a configuration's; a key that comes twice is refused. `overrides` must outlive the command.
CLI::Option* add_overrides(CLI::App* command, std::vector<std::string>& overrides, const std::string& help);

/// Throws Error where one of `options` was given: "--labels: WHY; leave it out".
void refuse_given(const CLI::App& command, std::initializer_list<const char*> options,
                  const std::string& why);

}  // namespace actformer::cli
