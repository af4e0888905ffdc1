"""The evaluation's report: tables and figures from the JSON sections that duet-eval writes."""
