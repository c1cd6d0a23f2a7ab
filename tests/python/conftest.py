"""What pytest says at the end of a run."""

import skips


def pytest_terminal_summary(terminalreporter):
    reports = terminalreporter.stats.get("skipped", [])
    if reports:
        terminalreporter.section("skipped, by reason")
        for line in skips.summary([skips.reason_of(report) for report in reports]):
            terminalreporter.write_line(line)
