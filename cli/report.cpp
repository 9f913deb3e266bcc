// actformer report: the papers' tables and all that stands behind them, as one HTML file.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/process/interruption.hpp"
#include "base/text/counted.hpp"
#include "cli/commands.hpp"
#include "cli/common_options.hpp"
#include "cli/format.hpp"
#include "cli/report.hpp"
#include "cli/say.hpp"
#include "cli/say_json.hpp"
#include "ingest/export/foreign.hpp"
#include "reports/page/exports.hpp"
#include "reports/page/page.hpp"
#include "reports/page/row_tables.hpp"

namespace actformer::cli {
namespace {

std::size_t trainings_among(const std::vector<reports::MeasuredRow>& rows) {
    return static_cast<std::size_t>(
        std::ranges::count_if(rows, [](const auto& row) { return row.sweep.empty(); }));
}

/// Figures in the tables that rows fill, else in those of all rows.
std::string contents_of_tables(std::size_t figures, const std::vector<reports::MeasuredRow>& rows) {
    return fmt::format("{} measured in {}", counted(figures, "figure"),
                       counted(rows.size() - trainings_among(rows), "row"));
}

/// Those figures, and curves of trainings.
std::string contents_of_page(std::size_t figures, const std::vector<reports::MeasuredRow>& rows) {
    const auto trainings = trainings_among(rows);
    if (trainings == 0) return contents_of_tables(figures, rows);
    const auto curves = fmt::format("curves of {}", counted(trainings, "training"));
    return rows.size() == trainings ? curves : contents_of_tables(figures, rows) + ", " + curves;
}

/// Says that it did.
void write_and_tell(const std::filesystem::path& path, const std::string& text, const std::string& contents) {
    write_whole(path, text);
    remark("{}: {}, {}\n", path.string(), contents, bytes(text.size()));
}

/// Whether a row is for a cell of the papers' tables.
bool fills_papers(const std::vector<reports::FilledTable>& tables) {
    const auto& papers = reports::paper_tables();
    return std::ranges::any_of(tables, [&](const auto& table) {
        return table.has_rows() &&
               std::ranges::find(papers, table.paper->id, &reports::PaperTable::id) != papers.end();
    });
}

/// Whether any of its runs waits or runs, as others of a row that failed may.
bool goes_on(const reports::MeasuredRow& row) {
    return std::ranges::any_of(
        row.runs, [](const auto& run) { return run.status == "waiting" || run.status == "running"; });
}

std::size_t measured_cells(const std::vector<reports::FilledTable>& tables) {
    std::size_t cells = 0;
    for (const auto& table : tables)
        for (const auto& row : table.rows)
            for (const auto& group : row)
                for (const auto& figures : group.figures) cells += figures.measured.has_value();
    return cells;
}

/// Writes the page anew every so many seconds, until nothing is left to be measured or a signal comes.
void watch(const ReportOptions& options, unsigned seconds) {
    const SafePoints safe_points;
    while (write_report(options)) {
        const auto next = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
        while (std::chrono::steady_clock::now() < next) {
            if (safe_points.asked()) safe_points.stop("the page is as it was last written");
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
    }
}

void refuse_foreign(const ReportOptions& options) {
    ingest::refuse_foreign(options.out, "report", [](std::string_view bytes) {
        return bytes.find(reports::in_every_page) != bytes.npos;
    });
    ingest::refuse_foreign(options.csv, "tables",
                           [](std::string_view bytes) { return bytes.starts_with(reports::csv_beginning); });
    ingest::refuse_foreign(options.latex, "tables", [](std::string_view bytes) {
        return bytes.starts_with(reports::latex_beginning);
    });
}

}  // namespace

bool write_report(const ReportOptions& options) {
    for (const auto& path : {options.out, options.csv, options.latex})
        if (!path.empty()) check_output(path);
    if (!options.force) refuse_foreign(options);
    auto measured = reports::read_measured(options.folders);
    auto tables = reports::fill_tables(measured);
    if (options.filled_only || !fills_papers(tables))
        std::erase_if(tables, [](const auto& table) { return !table.has_rows(); });
    const reports::RowTables rows(measured);
    const auto figures = measured_cells(tables.empty() ? rows.filled() : tables);
    tables.insert(tables.end(), rows.filled().begin(), rows.filled().end());
    if (!options.out.empty()) {
        const reports::DetailOptions details{static_cast<std::size_t>(1e6 * options.motion_megabytes)};
        const auto data = reports::details(measured, details);
        write_and_tell(options.out, reports::page(options.title, tables, measured.notices, data),
                       contents_of_page(figures, measured.rows));
    }
    const auto contents = contents_of_tables(figures, measured.rows);
    if (!options.csv.empty()) write_and_tell(options.csv, reports::to_csv(tables), contents);
    if (!options.latex.empty()) write_and_tell(options.latex, reports::to_latex(tables), contents);
    for (const auto& notice : measured.notices) remark("notice: {}\n", notice);
    if (options.json) say_json(reports::to_json(tables, measured.notices));
    return std::ranges::any_of(measured.rows, goes_on);
}

void add_report(CLI::App& app) {
    auto options = std::make_shared<ReportOptions>();
    auto* command =
        app.add_subcommand("report", "Write the papers' tables, curves, scores and motions as one HTML file");
    command->add_option("folders", options->folders, "Folders that `actformer sweep`, or a training, wrote")
        ->required();
    command->add_option("-o,--out", options->out, "The HTML file")->check(ends_in(".html"));
    command->add_option("--csv", options->csv, "The tables as comma-separated values, one line a figure")
        ->check(ends_in(".csv"));
    command->add_option("--latex", options->latex, "The tables for a paper")->check(ends_in(".tex"));
    command->add_option("--title", options->title, "The page's title")->capture_default_str();
    command
        ->add_option("--motion-megabytes", options->motion_megabytes,
                     "What the motions may add to the page, MB")
        ->check(number_in(0, 1000))
        ->capture_default_str();
    const auto seconds = std::make_shared<unsigned>(0);
    command
        ->add_option("--watch", *seconds,
                     "Write it anew every so many seconds until sweeps and trainings are done")
        ->check(CLI::Range(1, 86400))
        ->type_name("SECONDS");
    add_force_option(command, options->force);
    command->add_flag("--json", options->json, "Print the tables as JSON");
    examples(command,
             "  actformer report out/mini -o report.html\n"
             "  actformer report out/table3 out/table4 -o report.html --csv tables.csv --latex tables.tex\n"
             "  actformer report out/mini -o report.html --watch 60\n"
             "  actformer report my-training -o curves.html --watch 10\n"
             "  actformer report out/mini --json");
    command->callback([options, seconds] {
        if (options->out.empty() && options->csv.empty() && options->latex.empty() && !options->json)
            throw Error("nothing to write: give -o report.html, --csv FILE, --latex FILE or --json");
        if (*seconds > 0)
            watch(*options, *seconds);
        else
            write_report(*options);
    });
}

}  // namespace actformer::cli
