#include "experiments/bench/bench_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "experiments/bench/bench_sentences.hpp"
#include "experiments/bench/svg_chart.hpp"

namespace driftless {
namespace {

using nlohmann::json;

constexpr const char* style = R"(
:root { --ink:#1f2933; --soft:#52606d; --line:#d9dfe5; --ground:#f6f7f9; --sheet:#fff;
  --c0:#0b5cad; --c1:#b8480b; --c2:#6b7280; --c3:#0f766e; --c4:#86198f; --c5:#4d7c0f;
  --s0:#5b7fb5; --s1:#e0a030; --s2:#c2513a; --s3:#4f9d87; --s4:#9a86b8; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --ink:#e4e9ee; --soft:#a5b1bd; --line:#38424d;
  --ground:#14191f; --sheet:#1c232b; --c0:#6cb2ff; --c1:#ff9a5c; --c2:#a3adb8; --c3:#4fd1c0;
  --c4:#e08be8; --c5:#a9d45c; } }
* { box-sizing:border-box; }
body { margin:0; background:var(--ground); color:var(--ink);
  font:15px/1.5 system-ui,'Segoe UI',Roboto,'DejaVu Sans',sans-serif; }
header, main { max-width:1220px; margin:0 auto; padding:0 20px; }
h1 { margin:20px 0 4px; font-size:26px; } h2 { margin:0 0 8px; font-size:19px; }
h3 { margin:0 0 4px; font-size:15px; }
section { background:var(--sheet); border:1px solid var(--line); border-radius:8px;
  padding:16px 18px; margin:16px 0; }
p { margin:8px 0; max-width:100ch; } .soft { color:var(--soft); font-size:13px; }
.pair { display:grid; grid-template-columns:repeat(auto-fit,minmax(min(100%,440px),1fr)); gap:20px; }
svg { width:100%; height:auto; max-width:640px; display:block; }
text { fill:var(--ink); font-size:12px; } .tick, .legend, .level { font-size:11px; }
.tick { fill:var(--soft); } .middle { text-anchor:middle; } .end { text-anchor:end; }
.grid { stroke:var(--line); stroke-width:1; } .line { fill:none; stroke-width:2; }
.leader { stroke:var(--line); stroke-width:1; }
.broken { stroke-dasharray:7 3; } .dashed { stroke-dasharray:5 4; stroke-width:1.3; }
.dotted { stroke-dasharray:1.5 3; stroke-width:1.6; }
.open, .hollow { fill:var(--sheet); stroke-width:1.7; }
table { border-collapse:collapse; font-size:13px; font-variant-numeric:tabular-nums; }
th, td { padding:2px 10px; text-align:right; border-bottom:1px solid var(--line); }
th:first-child, td:first-child { text-align:left; } .scroll { overflow-x:auto; }
code { font-size:13px; overflow-wrap:anywhere; } summary { cursor:pointer; }
)";

/// The classes of lines and fillings.
std::string colour_rules() {
  std::string rules;
  for (int n = 0; n < 6; ++n) {
    rules += fmt::format(
        "line.c{0}, polyline.c{0}, circle.c{0} {{ stroke:var(--c{0}); }} "
        "circle.solid.c{0}, text.c{0} {{ fill:var(--c{0}); }} ",
        n);
  }
  for (int n = 0; n < 5; ++n) rules += fmt::format(".s{0} {{ fill:var(--s{0}); }} ", n);
  return rules;
}

std::string paragraph(const std::string& text) { return "<p>" + escaped(text) + "</p>\n"; }

std::string threads_name(unsigned threads) {
  return threads == 1 ? "1 thread" : fmt::format("{} threads", threads);
}

void add_point(ChartLine& line, double x, double y) {
  line.x.push_back(x);
  line.y.push_back(y);
}

std::string sizes_chart(const json& bench, const std::string& kernel) {
  const auto& scaling = bench["scaling"];
  std::map<unsigned, ChartLine> by_threads;
  for (const auto& row : scaling["sizes"]) {
    if (row["kernel"] != kernel) continue;
    auto& line = by_threads[row["threads"]];
    add_point(line, row["particles"], row["ns_per_particle_step"]);
  }
  LogChart chart{kernel, "particles", "ns per particle and step"};
  std::map<unsigned, std::size_t> colours;
  for (auto& [threads, line] : by_threads) {
    line.name = threads_name(threads);
    line.colour = colours.try_emplace(threads, colours.size()).first->second;
    chart.lines.push_back(line);
  }
  ChartLine naive{"naive reference, one core", 2, {}, {}, false, true};
  for (const auto& row : bench["rows"]) {
    if (row["kernel"] != kernel || row["naive_ns_per_particle_step"].is_null()) continue;
    add_point(naive, row["particles"], row["naive_ns_per_particle_step"]);
  }
  if (!naive.x.empty()) chart.lines.push_back(naive);
  for (const auto& limit : scaling["limits"]) {
    if (limit["kernel"] != kernel) continue;
    const unsigned threads = limit["threads"];
    const std::size_t colour = colours[threads];
    chart.levels.push_back(
        {"arithmetic, " + threads_name(threads), colour, limit["arithmetic_ns_per_particle_step"]});
    chart.levels.push_back(
        {"memory, " + threads_name(threads), colour, limit["memory_ns_per_particle_step"], true});
  }
  return svg(chart);
}

std::string threads_chart(const json& bench) {
  std::map<std::pair<std::string, std::size_t>, ChartLine> lines;
  std::map<std::pair<std::string, std::size_t>, double> alone;
  ChartLine ideal{"as many times as threads", 2, {}, {}, true};
  for (const auto& row : bench["scaling"]["threads"]) {
    const std::pair<std::string, std::size_t> key{row["kernel"], row["particles"]};
    const double time = row["ns_per_particle_step"];
    const unsigned threads = row["threads"];
    if (threads == 1) alone[key] = time;
    add_point(lines[key], threads, alone.at(key) / time);
    if (lines.size() == 1) add_point(ideal, threads, threads);
  }
  LogChart chart{"Speed-up over threads", "threads", "speed-up over one thread"};
  chart.y_from_zero = chart.x_ticks_at_points = true;
  chart.lines.push_back(ideal);
  constexpr std::size_t palette[] = {0, 1, 3, 4, 5};
  std::map<std::size_t, std::size_t> colours;
  for (auto& [key, line] : lines) {
    const auto place = colours.try_emplace(key.second, colours.size() % 5).first->second;
    line.colour = palette[place];
    line.dashed = key.first == "sequential";
    line.name =
        fmt::format("{}, {} particles", key.first, short_number(static_cast<double>(key.second)));
    chart.lines.push_back(line);
  }
  return svg(chart);
}

const std::vector<std::string> stage_names = {"search", "noise", "arithmetic", "scatter",
                                              "integration"};

std::vector<double> stage_values(const json& row) {
  std::vector<double> values;
  for (const auto& name : stage_names) values.push_back(row["stage_ns_per_particle_step"][name]);
  return values;
}

std::string methods_chart(const json& bench) {
  BarChart chart{"Stages of every method", "share of a step, %", stage_names, {}};
  for (const auto& row : bench["methods"]) {
    if (!row.contains("stage_ns_per_particle_step")) continue;
    auto values = stage_values(row);
    double sum = 0;
    for (const double value : values) sum += value;
    for (double& value : values) value *= 100 / sum;
    chart.bars.push_back({row["method"],
                          fmt::format("{:.0f} ns", row["ns_per_particle_step"].get<double>()),
                          values});
  }
  return svg(chart);
}

std::string terms_chart(const json& bench, const std::string& kernel) {
  BarChart chart{"Terms, " + kernel, "ns per particle and step", stage_names, {}};
  for (const auto& row : bench["scaling"]["terms"]) {
    if (row["kernel"] != kernel) continue;
    chart.bars.push_back({row["scene"],
                          fmt::format("{:.0f} ns", row["ns_per_particle_step"].get<double>()),
                          stage_values(row)});
  }
  return svg(chart);
}

std::string cell(const json& value, const char* format) {
  return value.is_null()
             ? "<td>-</td>"
             : fmt::format("<td>{}</td>", fmt::format(fmt::runtime(format), value.get<double>()));
}

std::string sizes_table(const json& bench) {
  std::string text =
      "<details><summary>The numbers</summary><div class=\"scroll\"><table><tr><th>kernel</th>"
      "<th>particles</th><th>threads</th><th>ns per particle-step</th><th>quartiles</th>"
      "<th>bytes per particle</th></tr>\n";
  for (const auto& row : bench["scaling"]["sizes"]) {
    text += fmt::format("<tr><td>{}</td>", escaped(row["kernel"].get<std::string>())) +
            cell(row["particles"], "{:.0f}") + cell(row["threads"], "{:.0f}") +
            cell(row["ns_per_particle_step"], "{:.1f}") +
            fmt::format("<td>{:.1f} to {:.1f}</td>", row["spread"]["lower"].get<double>(),
                        row["spread"]["upper"].get<double>()) +
            cell(row["bytes_per_particle"], "{:.0f}") + "</tr>\n";
  }
  return text + "</table></div></details>\n";
}

std::string traffic_table(const json& bench) {
  std::string text = "<details><summary>How the bytes of a step are estimated</summary>\n";
  text += paragraph(
      "An estimate for a system beyond the cache, from the sizes of what is stored: each array "
      "counts once for each loop over it, read or written. Bytes of a part = in order + pairs per "
      "particle x per pair. Particles lie nearly in the order of cells in which they are worked "
      "on. Tiles of 8 cells see 43 cells, their neighbours', in "
      "eight passes: what they see counts 43/8 times. What a shared cache keeps from one pass to "
      "the next makes a step faster than this limit. The triad counts its writes once too.");
  for (const auto& [kernel, parts] : bench["scaling"]["traffic"].items()) {
    text += "<h3>" + escaped(kernel) +
            "</h3><div class=\"scroll\"><table><tr><th>part</th><th>in order</th><th>per "
            "pair</th></tr>\n";
    for (const auto& part : parts) {
      text += "<tr><td>" + escaped(part["part"].get<std::string>()) + "</td>" +
              cell(part["bytes_in_order"], "{:.0f}") + cell(part["bytes_per_pair"], "{:.0f}") +
              "</tr>\n";
    }
    text += "</table></div>\n";
  }
  return text + "</details>\n";
}

std::string both_kernels(const json& bench, std::string (*chart)(const json&, const std::string&),
                         std::string (*sentence)(const json&, const std::string&)) {
  std::string text = "<div class=\"pair\">";
  for (const char* kernel : {"force-parallel", "sequential"}) {
    text += fmt::format("<div><h3>{}</h3>{}{}</div>", kernel, chart(bench, kernel),
                        paragraph(sentence(bench, kernel)));
  }
  return text + "</div>\n";
}

std::string head(const json& bench) {
  const auto& origin = bench["provenance"];
  const auto words = [&](const char* key) {
    return origin.contains(key) && origin[key].is_string() ? origin[key].get<std::string>() : "";
  };
  return fmt::format(
      "<header><h1>How the time of a step grows</h1><p class=\"soft\">Driftless {} ({}), {}; {}, "
      "{} usable CPUs; {}. Soft fluid with friction and conduction at density 3, step 0.01. "
      "Force-parallel is averaged-drift, sequential is shardlow-s1. Medians of interleaved samples "
      "by the clock on the wall.</p></header>\n",
      escaped(words("version")), escaped(words("commit")), escaped(words("compiler")),
      escaped(words("cpu")), origin["usable_cpus"].get<unsigned>(), escaped(words("date")));
}

std::string section(const std::string& title, const std::string& content) {
  return "<section><h2>" + escaped(title) + "</h2>\n" + content + "</section>\n";
}

}  // namespace

std::string bench_page(const json& bench) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:\"><link rel=\"icon\" href=\"data:,\">"
      "<title>Driftless: how the time of a step grows</title><style>";
  page += style + colour_rules() + "</style></head><body>\n" + head(bench) + "<main>\n";
  page +=
      section("Time of a step against the number of particles",
              both_kernels(bench, sizes_chart, sizes_sentence) + paragraph(memory_sentence(bench)) +
                  sizes_table(bench) + traffic_table(bench));
  page +=
      section("Speed-up over threads", threads_chart(bench) + paragraph(threads_sentence(bench)));
  page += section("What the methods spend their time on",
                  methods_chart(bench) + paragraph(methods_sentence(bench)));
  page += section("What terms cost", both_kernels(bench, terms_chart, terms_sentence));
  page += section("The command that repeats it",
                  "<p><code>" + escaped(bench["provenance"].value("command", "")) + "</code></p>");
  return page + "</main></body></html>\n";
}

}  // namespace driftless
