"""The planners that the swarm is measured against, behind the same ask and tell."""
