"""The paper's experiments: its tables and figures made again, beside what it prints."""
