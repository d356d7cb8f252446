"""What is flown, measured, compared and shown; the command line."""

__version__ = "0.1.0"
