#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""usage: dashboard_test.py DASHBOARD METRICS: every metric and label that the dashboard asks for is in the text.

METRICS is what zonectl metrics printed.
"""
import json
import re
import sys
from pathlib import Path

# What the scraper adds.
ADDED_LABELS = {"instance", "job"}


def labels_of(text):
    """Of each metric: the names of its labels."""
    metrics = {}
    for line in text.splitlines():
        sample = re.match(r"(zoned_\w+)(?:\{(.*)\})? \S+$", line)
        if sample:
            metrics.setdefault(sample[1], set()).update(re.findall(r'(\w+)="', sample[2] or ""))
    return metrics


def queries_of(dashboard):
    """Of each panel and variable: its name, its query, and the labels that its legend names."""
    for variable in dashboard["templating"]["list"]:
        if variable["type"] == "query":
            yield f"variable {variable['name']}", variable["query"]["query"], set()
    for panel in dashboard["panels"]:
        for target in panel["targets"]:
            legend = set(re.findall(r"\{\{(\w+)\}\}", target["legendFormat"]))
            yield f"panel {panel['title']}", target["expr"], legend


def main():
    dashboard = json.loads(Path(sys.argv[1]).read_text())
    metrics = labels_of(Path(sys.argv[2]).read_text())
    faults, count = [], 0
    for place, query, legend in queries_of(dashboard):
        names = re.findall(r"\bzoned_\w+", query)
        if not names:
            faults.append(f"{place} asks for no metric of zoned: {query}")
        for name in names:
            count += 1
            if name not in metrics:
                faults.append(f"{place} asks for {name}, which zonectl metrics does not print")
                continue
            asked = legend | set(re.findall(r"(\w+)=~", query)) | set(re.findall(r", (\w+)\)", query))
            for label in sorted(asked - metrics[name] - ADDED_LABELS):
                faults.append(f"{place} uses the label {label}, which {name} has not")
    ids = [panel["id"] for panel in dashboard["panels"]]
    if len(set(ids)) != len(ids):
        faults.append("two panels have the same id")
    for fault in faults:
        print(f"{sys.argv[1]}: {fault}")
    if count < 20:
        print(f"{sys.argv[1]}: only {count} metrics found")
    return 1 if faults or count < 20 else 0


sys.exit(main())
