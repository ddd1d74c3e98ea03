// The commands of the program, one file each: they parse, call and report.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

namespace vitrail::tool {

// Each adds its subcommand to `app`, and sets `run` to what it does when the user has chosen it.
void addRenderCommand(CLI::App& app, std::function<void()>& run);
void addViewCommand(CLI::App& app, std::function<void()>& run);
void addPickCommand(CLI::App& app, std::function<void()>& run);
void addCompareCommand(CLI::App& app, std::function<void()>& run);
void addBenchCommand(CLI::App& app, std::function<void()>& run);
void addInfoCommand(CLI::App& app, std::function<void()>& run);
void addScenesCommand(CLI::App& app, std::function<void()>& run);

// Gives a command a help page of its own in place of the generated one.
inline void setHelpPage(CLI::App& app, std::string page) {
  app.formatter_fn([page = std::move(page)](const CLI::App*, const std::string&, CLI::AppFormatMode) { return page; });
}

// Adds a command without options that does one thing.
inline void addPlainCommand(CLI::App& app, std::function<void()>& run, const char* name, const char* page,
                            void (*what)()) {
  CLI::App* command = app.add_subcommand(name);
  setHelpPage(*command, page);
  command->callback([&run, what] { run = what; });
}

} // namespace vitrail::tool
