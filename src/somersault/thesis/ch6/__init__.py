"""Chapter 6 of Playter (1994)."""
