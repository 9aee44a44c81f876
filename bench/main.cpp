// main.cpp -- runs the cases with Google Benchmark, in random order and again and again, so that a busy minute of the
// machine falls on all of them alike. The only file that includes Google Benchmark.
#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <regex>

#include "cases.h"
#include "machine.h"
#include "report.h"

namespace isoparm::bench {
namespace {

constexpr const char* kHelp =
    R"(usage: isoparm_bench [--json FILE] [--repetitions N] [--seconds S] [--filter REGEX] [--list]

--json FILE       write everything that was measured to FILE too, - for the standard output instead of the tables
--repetitions N   of every case (default 7; 3 at most of those that take seconds)
--seconds S       at least, for each repetition (default 0.1)
--filter REGEX    only cases whose "table / name" matches
--list            only name the cases
)";

constexpr const char* kClockNames[] = {"thread", "core", "wall"};

struct Arguments {
    std::string json;
    int repetitions = 7;
    double seconds = 0.1;
    std::regex filter{""};
    bool list = false;
};

Arguments parse(int argc, char** argv) {
    Arguments a;
    for (int i = 1; i < argc; ++i) {
        const std::string option = argv[i];
        const auto value = [&]() -> std::string {
            if (i + 1 == argc) throw std::invalid_argument(option + " needs a value");
            return argv[++i];
        };
        if (option == "--json")
            a.json = value();
        else if (option == "--repetitions")
            a.repetitions = std::stoi(value());
        else if (option == "--seconds")
            a.seconds = std::stod(value());
        else if (option == "--filter")
            a.filter = value();
        else if (option == "--list")
            a.list = true;
        else
            throw std::invalid_argument("unknown option " + option);
    }
    if (a.repetitions < 1 || !(a.seconds > 0))
        throw std::invalid_argument("--repetitions and --seconds must be positive");
    return a;
}

std::string full_name(const Case& c) { return c.table + " / " + c.name; }

/// Of each case, besides its rates.
struct Known {
    std::vector<std::pair<std::string, double>> facts;  // of the last round
    double busy = 0, wall = 0;                          // seconds of all processors, of the clock
};
using Facts = std::map<std::string, Known>;

void run(benchmark::State& state, const Case& c, Facts& facts) {
    if (c.prepare) c.prepare();
    std::optional<tbb::global_control> limit;
    if (c.clock == Clock::one_thread) limit.emplace(tbb::global_control::max_allowed_parallelism, 1);
    double amount = 0;
    auto& known = facts[full_name(c)];
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t busy = std::clock();
    for (auto _ : state) {
        const Work w = c.round();
        amount += w.amount;
        known.facts = w.facts;
    }
    state.counters["amount"] = amount;
    known.wall += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    known.busy += double(std::clock() - busy) / CLOCKS_PER_SEC;
}

/// Collects the rates and shows how far it is.
class Collector : public benchmark::BenchmarkReporter {
public:
    Collector(const std::vector<Case>& cases, const Facts& facts) : cases_(cases), facts_(facts) {}
    bool ReportContext(const Context&) override { return true; }
    void ReportRuns(const std::vector<Run>& runs) override {
        for (const Run& r : runs) {
            if (r.run_type != Run::RT_Iteration) continue;
            const Case& c = cases_.at(std::stoul(r.run_name.function_name));
            const double seconds = c.clock == Clock::wall ? r.real_accumulated_time : r.cpu_accumulated_time;
            rates_[full_name(c)].push_back(r.counters.at("amount").value / seconds);
        }
    }
    std::vector<Measured> measured() const {
        std::vector<Measured> all;
        for (const Case& c : cases_) {
            const auto found = rates_.find(full_name(c));
            if (found == rates_.end()) continue;
            const Known& known = facts_.at(full_name(c));
            all.push_back({c.table, c.name, c.unit, kClockNames[static_cast<int>(c.clock)], c.reference, found->second,
                           known.facts});
            // Other work takes its share of the cores: so many were really had.
            if (c.clock == Clock::wall) all.back().facts.emplace_back("cores had", known.busy / known.wall);
        }
        return all;
    }

private:
    const std::vector<Case>& cases_;
    const Facts& facts_;
    std::map<std::string, std::vector<double>> rates_;
};

void measure(const std::vector<Case>& cases, const Arguments& arguments, Facts& facts, Collector& collector) {
    for (std::size_t k = 0; k < cases.size(); ++k) {
        const Case& c = cases[k];
        auto* b = benchmark::RegisterBenchmark(std::to_string(k).c_str(),
                                               [&c, &facts](benchmark::State& s) { run(s, c, facts); });
        b->Repetitions(std::min(arguments.repetitions, c.repetitions))->MinTime(arguments.seconds);
        if (c.clock == Clock::core_seconds) b->MeasureProcessCPUTime();
        if (c.clock == Clock::wall) b->UseRealTime();
    }
    std::string program = "isoparm_bench", interleaved = "--benchmark_enable_random_interleaving=true";
    char* argv[] = {program.data(), interleaved.data(), nullptr};
    int argc = 2;
    benchmark::Initialize(&argc, argv);
    benchmark::RunSpecifiedBenchmarks(&collector);
}

int bench(const Arguments& arguments) {
    std::vector<Case> cases;
    for (auto make : {evaluation_cases, batch_cases, tightness_cases, tessellation_cases, peer_cases, ray_cases})
        for (Case& c : make())
            if (std::regex_search(full_name(c), arguments.filter)) cases.push_back(std::move(c));
    if (arguments.list) {
        for (const Case& c : cases) std::cout << full_name(c) << '\n';
        return 0;
    }
    Place place;
    place.machine = machine_line();
    place.load_before = load_average();
    std::fprintf(stderr, "%s\n%zu cases, a few minutes ...\n", place.machine.c_str(), cases.size());
    Facts facts;
    Collector collector(cases, facts);
    measure(cases, arguments, facts, collector);
    place.load_after = load_average();

    const std::vector<Measured> all = collector.measured();
    if (arguments.json != "-") write_tables(std::cout, place, all);
    if (arguments.json == "-")
        write_json(std::cout, place, all);
    else if (!arguments.json.empty()) {
        std::ofstream file(arguments.json);
        write_json(file, place, all);
        if (!file.flush()) throw std::runtime_error(arguments.json + ": cannot be written");
    }
    return 0;
}

}  // namespace
}  // namespace isoparm::bench

int main(int argc, char** argv) {
    using namespace isoparm::bench;
    for (int i = 1; i < argc; ++i)
        if (std::string(argv[i]) == "--help") return std::fputs(kHelp, stdout) < 0;
    try {
        return bench(parse(argc, argv));
    } catch (const std::invalid_argument& e) {
        std::fprintf(stderr, "isoparm_bench: %s\n%s", e.what(), kHelp);
        return 64;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "isoparm_bench: %s\n", e.what());
        return 70;
    }
}
