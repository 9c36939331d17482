#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

/// The commands of the program, each with its options and help. What a call asks for is kept by the
/// command itself.
namespace driftless::commands {

void add_run(CLI::App& app);
void add_check(CLI::App& app);
void add_report(CLI::App& app);
void add_recommend(CLI::App& app);
void add_judge(CLI::App& app);
void add_simulate(CLI::App& app, std::string call);  ///< the program's call, as runs keep it
void add_keep(CLI::App& app);
void add_lists(CLI::App& app);  ///< methods, scenes, observables, schema
void add_bench(CLI::App& app);

/// These two set the exit code where they run to their end and yet something is amiss: 1 if a
/// paper's experiment failed, or if a gate finds a method worse.
void add_reproduce(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);

/// --threads, 0 if it is not given.
void add_threads(CLI::App& command, unsigned& threads);
/// "driftless --methods FILE ...": the program with the methods from outside that were loaded.
std::string program_with_methods();
/// What was found, and where its page is.
void print_written(const std::string& summary, const std::filesystem::path& page);

}  // namespace driftless::commands
